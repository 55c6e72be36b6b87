// SPDX-License-Identifier: MIT
#include "game/play/loop/play_screen.h"

#include "engine/graph/execute.h"
#include "game/options/program.h"

#include <utility>

namespace shutter::game {

PlayScreen::~PlayScreen() {
    releaseDrawing();
}

void PlayScreen::releaseDrawing() {
    mUi.reset();
    mSwapchain.reset(); // before the window that it shows on
}

core::Status PlayScreen::open(const PlayOptions& options, bool vsync) {
    const ShotOptions& shot = options.shot;
    gpu::DeviceOptions wanted = options.device;
    wanted.cacheFolder = findCacheFolder();
    wanted.pipelinesAhead = gpu::PipelinesAhead::OnGpus;
    mHeadlessSize = {shot.width, shot.height};
    if (options.hasWindow) {
        auto window = app::Window::open({"Shutter", shot.width, shot.height});
        if (!window)
            return core::makeError("{}; --no-window does without", window.error().message);
        mWindow = std::move(window).value();
        wanted.surfaceExtensions = mWindow->surfaceExtensions();
        wanted.makeSurface = [this](VkInstance instance) {
            return mWindow->createSurface(instance);
        };
    }
    auto device = gpu::Device::create(wanted);
    if (!device)
        return device.error();
    mDevice = std::move(device).value();
    if (mWindow)
        SHUTTER_TRY(openSwapchain(vsync));
    mUi = std::make_unique<app::Ui>(*mDevice);
    return {};
}

core::Status PlayScreen::openSwapchain(bool vsync) {
    const math::uvec2 size = mWindow->framebufferSize();
    auto swapchain =
        gpu::Swapchain::create(*mDevice, mDevice->takeSurface(), {size.x, size.y, vsync});
    if (!swapchain)
        return swapchain.error();
    mSwapchain = std::move(swapchain).value();
    return {};
}

math::uvec2 PlayScreen::size() const {
    return mWindow ? mWindow->framebufferSize() : mHeadlessSize;
}

double PlayScreen::contentScale() const {
    return mWindow ? mWindow->contentScale() : 1.0;
}

app::InputCollector& PlayScreen::collector(bool isScripted) {
    return isScripted || !mWindow ? mInput : mWindow->input();
}

void PlayScreen::poll(bool wait) {
    if (mWindow)
        mWindow->poll(wait);
}

bool PlayScreen::closeRequested() const {
    return mWindow && mWindow->closeRequested();
}

void PlayScreen::setTitle(const std::string& title) {
    if (mWindow)
        mWindow->setTitle(title);
}

void PlayScreen::resize(const math::uvec2& size) {
    mHeadlessSize = size;
    if (mWindow)
        mWindow->resize(size.x, size.y);
}

void PlayScreen::apply(app::WindowAction action) {
    if (!mWindow)
        return;
    switch (action) {
    case app::WindowAction::Minimise:
        mWindow->minimise();
        break;
    case app::WindowAction::Restore:
        mWindow->restore();
        break;
    case app::WindowAction::FullScreen:
    case app::WindowAction::Windowed:
        mWindow->setFullScreen(action == app::WindowAction::FullScreen);
        break;
    case app::WindowAction::Quit:
        break;
    }
}

void PlayScreen::toggleFullScreen() {
    if (mWindow)
        mWindow->setFullScreen(!mWindow->isFullScreen());
}

void PlayScreen::keepPipelines() {
    mKeeping =
        std::async(std::launch::async, [device = mDevice.get()] { device->savePipelineCache(); });
}

core::Status PlayScreen::showUi() {
    if (!mSwapchain || !mSwapchain->hasImages())
        return {};
    const auto shown = mSwapchain->acquire();
    if (!shown)
        return {};

    struct Data {
        graph::ImageHandle window;
    };

    const gpu::SwapchainDesc& size = mSwapchain->desc();
    gpu::Frame frame(*mDevice);
    graph::TransientPool pool(*mDevice);
    frame.begin();
    graph::Graph graph;
    const auto window = graph.importImage(
        "window", *shown->image, VK_IMAGE_LAYOUT_UNDEFINED, VK_IMAGE_LAYOUT_PRESENT_SRC_KHR
    );
    const app::OverlayTarget target{mSwapchain->format(), size.width, size.height, 0};
    graph.addPass<Data>(
        "user interface",
        graph::PassKind::Raster,
        [&](graph::PassBuilder& builder, Data& data) {
            data.window = builder.colorTarget(window, graph::ClearColor::floats(0, 0, 0, 1));
            graph.markOutput(data.window);
            builder.startBatch();
        },
        [&](const Data&, graph::PassContext& recording) { mUi->record(recording.frame, target); }
    );
    if (const auto plan = graph::execute(graph, frame, pool); !plan)
        return plan.error();
    frame.submit(shown->semaphores);
    mSwapchain->present(*shown);
    frame.wait(); // the user interface records into the slot's buffers again
    return {};
}

void PlayScreen::remakeSwapchain(const gpu::SwapchainDesc& desc, PlayRenderer& renderer) {
    renderer.finishAll();
    if (mSwapchain->state() != gpu::SwapchainState::SurfaceLost) {
        mSwapchain->resize(desc);
        return;
    }
    // If the window has no new surface yet, the next iteration tries again.
    if (const auto surface = mWindow->createSurface(mDevice->instance()))
        mSwapchain->resize(desc, surface.value());
}

bool PlayScreen::fit(const math::uvec2& sizePx, bool vsync, PlayRenderer& renderer) {
    const gpu::SwapchainDesc wanted{sizePx.x, sizePx.y, vsync};
    if (mSwapchain->wanted() != wanted || mSwapchain->state() != gpu::SwapchainState::Fits)
        remakeSwapchain(wanted, renderer);
    return mSwapchain->hasImages();
}

} // namespace shutter::game
