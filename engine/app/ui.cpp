// SPDX-License-Identifier: MIT
#include "engine/app/ui.h"

#include "spirv/app/ui.frag.h"
#include "spirv/app/ui.vert.h"

#include "engine/app/ui_font.h"
#include "engine/core/check.h"
#include "engine/gpu/memory.h"
#include "engine/gpu/upload.h"
#include "engine/gpu/vulkan.h"
#include "shaders/app/app_shared.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <imgui.h>
#include <map>
#include <utility>

namespace shutter::app {

namespace {

static_assert(sizeof(ImDrawVert) == sizeof(shader::UiVertex));
static_assert(offsetof(ImDrawVert, uv) == offsetof(shader::UiVertex, uv));
static_assert(offsetof(ImDrawVert, col) == offsetof(shader::UiVertex, color));

/// ImGui takes no time of 0.
constexpr double kShortestFrame = 1.0e-5;

gpu::GraphicsPipelineDesc describeUiPipeline(VkFormat format) {
    gpu::GraphicsPipelineDesc desc;
    desc.name = "user interface";
    desc.vertexSpirv = app_ui_vert;
    desc.fragmentSpirv = app_ui_frag;
    desc.interface.bindings = {VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER};
    desc.interface.pushConstantBytes = sizeof(shader::UiParams);
    desc.colorFormats = {format};
    desc.blend = gpu::Blend::Over;
    return desc;
}

/// Grows by halves, so that a panel that unfolds does not allocate in every frame.
void reserve(
    gpu::Device& device,
    gpu::Buffer& buffer,
    const char* name,
    VkDeviceSize bytes,
    VkBufferUsageFlags usage
) {
    if (buffer && buffer.bytes() >= bytes)
        return;
    const VkDeviceSize wanted = std::max<VkDeviceSize>(bytes + bytes / 2, 64 << 10);
    buffer = gpu::Buffer(device, name, wanted, usage, gpu::MemoryUse::Stream);
}

/// The part of a clip rectangle that lies in the target; empty where none does.
VkRect2D clampScissor(const ImVec4& clip, const OverlayTarget& target) {
    const auto width = static_cast<float>(target.width);
    const auto height = static_cast<float>(target.height);
    // Written so that NaN ends up in the target too.
    const auto within = [](float value, float highest) {
        return value > 0.0f ? std::min(value, highest) : 0.0f;
    };
    const auto left = static_cast<int32_t>(within(clip.x, width));
    const auto top = static_cast<int32_t>(within(clip.y, height));
    const auto right = static_cast<int32_t>(within(clip.z, width));
    const auto bottom = static_cast<int32_t>(within(clip.w, height));
    return {
        {left, top},
        {static_cast<uint32_t>(std::max(right - left, 0)),
         static_cast<uint32_t>(std::max(bottom - top, 0))}};
}

void setStyle(float scale) {
    ImGuiStyle style;
    ImGui::StyleColorsDark(&style);
    style.Colors[ImGuiCol_WindowBg].w = 0.88f;                         // text over any picture
    style.Colors[ImGuiCol_TextDisabled] = {0.66f, 0.66f, 0.66f, 1.0f}; // meant to be read
    style.Colors[ImGuiCol_SliderGrab] = {0.2f, 0.38f, 0.62f, 1.0f};    // numbers lie over it
    style.WindowRounding = 0.0f;
    style.ScaleAllSizes(scale);
    ImGui::GetStyle() = style;
}

/// A font of the height in the atlas, which is read texel by texel: no oversampling.
void addFont(ImFontAtlas& atlas, float heightPx) {
    ImFontConfig config;
    config.OversampleH = config.OversampleV = 1;
    config.PixelSnapH = true;
    config.SizePixels = heightPx;
    if constexpr (sizeof(kUiFont) <= 1) { // the zero behind an absent font
        atlas.AddFontDefault(&config);
        return;
    }
    config.FontDataOwnedByAtlas = false;
    // ImGui takes a non-const pointer but only reads the bytes.
    atlas.AddFontFromMemoryTTF(
        const_cast<char*>(kUiFont), static_cast<int>(sizeof(kUiFont) - 1), heightPx, &config
    );
}

/// Keys that widgets and text fields read; the game's own keys are none of ImGui's business.
constexpr std::pair<Key, ImGuiKey> kKeys[] = {
    {Key::Tab, ImGuiKey_Tab},
    {Key::Left, ImGuiKey_LeftArrow},
    {Key::Right, ImGuiKey_RightArrow},
    {Key::Up, ImGuiKey_UpArrow},
    {Key::Down, ImGuiKey_DownArrow},
    {Key::PageUp, ImGuiKey_PageUp},
    {Key::PageDown, ImGuiKey_PageDown},
    {Key::Home, ImGuiKey_Home},
    {Key::End, ImGuiKey_End},
    {Key::Delete, ImGuiKey_Delete},
    {Key::Backspace, ImGuiKey_Backspace},
    {Key::Space, ImGuiKey_Space},
    {Key::Enter, ImGuiKey_Enter},
    {Key::Escape, ImGuiKey_Escape},
    {Key::A, ImGuiKey_A},
    {Key::C, ImGuiKey_C},
    {Key::V, ImGuiKey_V},
    {Key::X, ImGuiKey_X},
    {Key::Y, ImGuiKey_Y},
    {Key::Z, ImGuiKey_Z},
};

bool isHeld(const InputState& input, Key key) {
    return input.isDown(key) || input.wasPressed(key);
}

bool isHeld(const InputState& input, MouseButton button) {
    const auto index = static_cast<size_t>(button);
    return input.buttons[index] || input.clicked[index];
}

// ImGui's order of buttons.
constexpr MouseButton kUiButtons[] = {MouseButton::Left, MouseButton::Right, MouseButton::Middle};

} // namespace

struct Ui::State {
    explicit State(gpu::Device& d) : device(d) {}

    /// What one frame in flight draws from.
    struct Slot {
        gpu::Buffer vertices;
        gpu::Buffer indices;
    };

    void setScale(float newScale);
    void copy(const ImDrawData& data, Slot& slot);
    const gpu::Pipeline& findPipeline(VkFormat format);

    gpu::Device& device;
    gpu::Image font;
    float scale = 0.0f; ///< of the font; 0: there is none yet
    bool isComplete = false;
    std::array<Slot, gpu::kMaxFramesInFlight> slots;
    std::map<VkFormat, gpu::Pipeline> pipelines;
};

void Ui::State::setScale(float newScale) {
    if (newScale == scale)
        return;
    scale = newScale;
    setStyle(scale);
    ImFontAtlas& atlas = *ImGui::GetIO().Fonts;
    atlas.Clear();
    atlas.Flags |= ImFontAtlasFlags_NoBakedLines; // they want a filter
    for (const float size : {kTextPx, kLargeTextPx})
        addFont(atlas, std::floor(size * scale));
    unsigned char* texels = nullptr;
    int width = 0;
    int height = 0;
    atlas.GetTexDataAsAlpha8(&texels, &width, &height);
    gpu::ImageDesc desc;
    desc.width = static_cast<uint32_t>(width);
    desc.height = static_cast<uint32_t>(height);
    desc.format = VK_FORMAT_R8_UNORM;
    desc.usage = VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT |
                 VK_IMAGE_USAGE_TRANSFER_SRC_BIT;
    font = gpu::Image(device, "font atlas", desc);
    gpu::uploadTexture(
        device, font, std::as_bytes(std::span(texels, size_t(desc.width) * desc.height))
    );
}

void Ui::State::copy(const ImDrawData& data, Slot& slot) {
    const auto vertexBytes = sizeof(ImDrawVert) * static_cast<size_t>(data.TotalVtxCount);
    const auto indexBytes = sizeof(ImDrawIdx) * static_cast<size_t>(data.TotalIdxCount);
    reserve(device, slot.vertices, "user interface vertices", vertexBytes, 0);
    reserve(
        device, slot.indices, "user interface indices", indexBytes, VK_BUFFER_USAGE_INDEX_BUFFER_BIT
    );
    VkDeviceSize vertexOffset = 0;
    VkDeviceSize indexOffset = 0;
    for (int i = 0; i < data.CmdListsCount; ++i) {
        const ImDrawList& list = *data.CmdLists[i];
        const auto bytes = [](const auto& v) { return static_cast<size_t>(v.Size) * sizeof(v[0]); };
        slot.vertices.writeBytes(list.VtxBuffer.Data, bytes(list.VtxBuffer), vertexOffset);
        slot.indices.writeBytes(list.IdxBuffer.Data, bytes(list.IdxBuffer), indexOffset);
        vertexOffset += bytes(list.VtxBuffer);
        indexOffset += bytes(list.IdxBuffer);
    }
}

const gpu::Pipeline& Ui::State::findPipeline(VkFormat format) {
    auto found = pipelines.find(format);
    if (found == pipelines.end())
        found = pipelines.emplace(format, gpu::Pipeline(device, describeUiPipeline(format))).first;
    return found->second;
}

Ui::Ui(gpu::Device& device) : mState(std::make_unique<State>(device)) {
    SHUTTER_CHECK(ImGui::GetCurrentContext() == nullptr, "there is a user interface already");
    IMGUI_CHECKVERSION();
    ImGui::CreateContext();
    ImGuiIO& io = ImGui::GetIO();
    io.IniFilename = nullptr; // writes no .ini file
    io.LogFilename = nullptr;
    io.BackendPlatformName = "shutter";
    io.BackendRendererName = "shutter";
    io.BackendFlags |= ImGuiBackendFlags_RendererHasVtxOffset;
    io.ConfigWindowsMoveFromTitleBarOnly = true;
    mapKeys();
}

Ui::~Ui() {
    ImGui::DestroyContext();
}

void Ui::begin(const InputState& input, const math::uvec2& windowPx, double scale, double seconds) {
    mState->isComplete = false;
    mState->setScale(static_cast<float>(std::isnan(scale) ? 1.0 : std::clamp(scale, 0.5, 8.0)));
    ImGuiIO& io = ImGui::GetIO();
    io.DisplaySize = {static_cast<float>(windowPx.x), static_cast<float>(windowPx.y)};
    io.DeltaTime = static_cast<float>(seconds > kShortestFrame ? seconds : kShortestFrame);
    feedInput(input);
    ImGui::NewFrame();
}

void Ui::end() {
    ImGui::Render();
    mState->isComplete = true;
}

bool Ui::wantsPointer() const {
    return ImGui::GetIO().WantCaptureMouse;
}

bool Ui::wantsKeys() const {
    return ImGui::GetIO().WantTextInput;
}

void Ui::record(gpu::Frame& frame, const OverlayTarget& target) {
    if (!mState->isComplete)
        return;
    const ImDrawData& data = *ImGui::GetDrawData();
    if (data.TotalIdxCount == 0)
        return;
    State::Slot& slot = mState->slots.at(target.slot);
    mState->copy(data, slot);
    shader::UiParams params{};
    params.vertices = gpu::splitAddress(slot.vertices.address());
    params.clipPerPixel = {2.0f / data.DisplaySize.x, 2.0f / data.DisplaySize.y};
    gpu::BindingList bindings;
    bindings.sampled(mState->font.view(), mState->device.nearestSampler());
    frame.bind(mState->findPipeline(target.format), bindings, &params, sizeof(params));
    const VkCommandBuffer commands = frame.commands();
    vkCmdSetCullMode(commands, VK_CULL_MODE_NONE);
    vkCmdSetFrontFace(commands, VK_FRONT_FACE_COUNTER_CLOCKWISE);
    constexpr VkIndexType kIndexType =
        sizeof(ImDrawIdx) == 2 ? VK_INDEX_TYPE_UINT16 : VK_INDEX_TYPE_UINT32;
    vkCmdBindIndexBuffer(commands, slot.indices.handle(), 0, kIndexType);
    uint32_t firstIndex = 0;
    uint32_t firstVertex = 0;
    for (int i = 0; i < data.CmdListsCount; ++i) {
        const ImDrawList& list = *data.CmdLists[i];
        for (const ImDrawCmd& command : list.CmdBuffer) {
            SHUTTER_CHECK(!command.UserCallback, "callbacks of draw lists are not supported");
            const VkRect2D scissor = clampScissor(command.ClipRect, target);
            if (scissor.extent.width == 0 || scissor.extent.height == 0)
                continue;
            vkCmdSetScissor(commands, 0, 1, &scissor);
            vkCmdDrawIndexed(
                commands,
                command.ElemCount,
                1,
                firstIndex + command.IdxOffset,
                static_cast<int32_t>(firstVertex + command.VtxOffset),
                0
            );
        }
        firstIndex += static_cast<uint32_t>(list.IdxBuffer.Size);
        firstVertex += static_cast<uint32_t>(list.VtxBuffer.Size);
    }
}

// From 1.87 on ImGui takes events; before, it reads arrays that its host writes.
#if IMGUI_VERSION_NUM >= 18700

void mapKeys() {
    // A frame's input is that frame's: none of it is put off to the next.
    ImGui::GetIO().ConfigInputTrickleEventQueue = false;
}

void feedInput(const InputState& input) {
#if IMGUI_VERSION_NUM >= 18900
    constexpr ImGuiKey kShift = ImGuiMod_Shift;
    constexpr ImGuiKey kControl = ImGuiMod_Ctrl;
    constexpr ImGuiKey kAlt = ImGuiMod_Alt;
#else
    constexpr ImGuiKey kShift = ImGuiKey_ModShift;
    constexpr ImGuiKey kControl = ImGuiKey_ModCtrl;
    constexpr ImGuiKey kAlt = ImGuiKey_ModAlt;
#endif
    ImGuiIO& io = ImGui::GetIO();
    io.AddMousePosEvent(
        static_cast<float>(input.pointerPx.x), static_cast<float>(input.pointerPx.y)
    );
    for (int i = 0; i < 3; ++i)
        io.AddMouseButtonEvent(i, isHeld(input, kUiButtons[i]));
    if (input.wheel != 0.0)
        io.AddMouseWheelEvent(0.0f, static_cast<float>(input.wheel));
    io.AddKeyEvent(kShift, isHeld(input, Key::Shift));
    io.AddKeyEvent(kControl, isHeld(input, Key::Control));
    io.AddKeyEvent(kAlt, isHeld(input, Key::Alt));
    for (const auto& [key, theirs] : kKeys)
        io.AddKeyEvent(theirs, isHeld(input, key));
    for (const uint32_t character : input.characters)
        io.AddInputCharacter(character);
}

#else

void mapKeys() {
    ImGuiIO& io = ImGui::GetIO();
    for (const auto& [key, theirs] : kKeys)
        io.KeyMap[theirs] = static_cast<int>(key);
}

void feedInput(const InputState& input) {
    ImGuiIO& io = ImGui::GetIO();
    io.MousePos = {static_cast<float>(input.pointerPx.x), static_cast<float>(input.pointerPx.y)};
    for (int i = 0; i < 3; ++i)
        io.MouseDown[i] = isHeld(input, kUiButtons[i]);
    io.MouseWheel += static_cast<float>(input.wheel);
    io.KeyShift = isHeld(input, Key::Shift);
    io.KeyCtrl = isHeld(input, Key::Control);
    io.KeyAlt = isHeld(input, Key::Alt);
    for (const auto& row : kKeys)
        io.KeysDown[static_cast<size_t>(row.first)] = isHeld(input, row.first);
    for (const uint32_t character : input.characters)
        io.AddInputCharacter(character);
}

#endif

} // namespace shutter::app
