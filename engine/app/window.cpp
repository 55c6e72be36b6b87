// SPDX-License-Identifier: MIT
#include "engine/app/window.h"

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>

#include <algorithm>
#include <array>
#include <utility>

namespace shutter::app {

namespace {

/// GLFW's last error, or a default sentence.
std::string describeProblem() {
    const char* description = nullptr;
    glfwGetError(&description);
    return description ? description : "the window system gave no reason";
}

/// Nothing for a key that has no name here.
std::optional<Key> translateKey(int code) {
    const auto offset = [](Key first, int by) {
        return static_cast<Key>(static_cast<int>(first) + by);
    };
    if (code >= GLFW_KEY_A && code <= GLFW_KEY_Z)
        return offset(Key::A, code - GLFW_KEY_A);
    if (code >= GLFW_KEY_0 && code <= GLFW_KEY_9)
        return offset(Key::Digit0, code - GLFW_KEY_0);
    if (code >= GLFW_KEY_F1 && code <= GLFW_KEY_F12)
        return offset(Key::F1, code - GLFW_KEY_F1);
    constexpr std::pair<int, Key> kOthers[] = {
        {GLFW_KEY_LEFT, Key::Left},
        {GLFW_KEY_RIGHT, Key::Right},
        {GLFW_KEY_UP, Key::Up},
        {GLFW_KEY_DOWN, Key::Down},
        {GLFW_KEY_SPACE, Key::Space},
        {GLFW_KEY_ENTER, Key::Enter},
        {GLFW_KEY_KP_ENTER, Key::Enter},
        {GLFW_KEY_ESCAPE, Key::Escape},
        {GLFW_KEY_TAB, Key::Tab},
        {GLFW_KEY_BACKSPACE, Key::Backspace},
        {GLFW_KEY_DELETE, Key::Delete},
        {GLFW_KEY_HOME, Key::Home},
        {GLFW_KEY_END, Key::End},
        {GLFW_KEY_PAGE_UP, Key::PageUp},
        {GLFW_KEY_PAGE_DOWN, Key::PageDown},
        {GLFW_KEY_LEFT_SHIFT, Key::Shift},
        {GLFW_KEY_RIGHT_SHIFT, Key::Shift},
        {GLFW_KEY_LEFT_CONTROL, Key::Control},
        {GLFW_KEY_RIGHT_CONTROL, Key::Control},
        {GLFW_KEY_LEFT_ALT, Key::Alt},
        {GLFW_KEY_RIGHT_ALT, Key::Alt},
        {GLFW_KEY_MINUS, Key::Minus},
        {GLFW_KEY_EQUAL, Key::Equal},
        {GLFW_KEY_PERIOD, Key::Period},
        {GLFW_KEY_COMMA, Key::Comma},
        {GLFW_KEY_SLASH, Key::Slash}};
    for (const auto& [other, key] : kOthers)
        if (other == code)
            return key;
    return std::nullopt;
}

std::optional<MouseButton> translateButton(int code) {
    switch (code) {
    case GLFW_MOUSE_BUTTON_LEFT:
        return MouseButton::Left;
    case GLFW_MOUSE_BUTTON_RIGHT:
        return MouseButton::Right;
    case GLFW_MOUSE_BUTTON_MIDDLE:
        return MouseButton::Middle;
    default:
        return std::nullopt;
    }
}

Window& windowOf(GLFWwindow* window) {
    return *static_cast<Window*>(glfwGetWindowUserPointer(window));
}

/// The monitor that most of the window lies on.
GLFWmonitor* findMonitor(GLFWwindow* window) {
    int x = 0;
    int y = 0;
    int width = 0;
    int height = 0;
    glfwGetWindowPos(window, &x, &y);
    glfwGetWindowSize(window, &width, &height);
    int count = 0;
    GLFWmonitor** monitors = glfwGetMonitors(&count);
    GLFWmonitor* best = glfwGetPrimaryMonitor();
    int bestArea = 0;
    for (int i = 0; i < count; ++i) {
        int left = 0;
        int top = 0;
        glfwGetMonitorPos(monitors[i], &left, &top);
        const GLFWvidmode* mode = glfwGetVideoMode(monitors[i]);
        if (!mode)
            continue;
        const int across = std::min(x + width, left + mode->width) - std::max(x, left);
        const int down = std::min(y + height, top + mode->height) - std::max(y, top);
        const int area = std::max(across, 0) * std::max(down, 0);
        if (area > bestArea) {
            bestArea = area;
            best = monitors[i];
        }
    }
    return best;
}

} // namespace

core::Result<std::unique_ptr<Window>> Window::open(const WindowDesc& desc) {
    if (!glfwInit())
        return core::makeError("no window can be opened: {}", describeProblem());
    std::unique_ptr<Window> window(new Window);
    if (!glfwVulkanSupported())
        return core::makeError("no window can be opened: this display has no Vulkan");
    glfwWindowHint(GLFW_CLIENT_API, GLFW_NO_API);
    glfwWindowHint(GLFW_SCALE_TO_MONITOR, GLFW_TRUE);
    window->mWindow = glfwCreateWindow(
        static_cast<int>(desc.width),
        static_cast<int>(desc.height),
        desc.title.c_str(),
        nullptr,
        nullptr
    );
    if (!window->mWindow)
        return core::makeError("no window can be opened: {}", describeProblem());
    window->listen();
    return window;
}

Window::~Window() {
    if (mWindow)
        glfwDestroyWindow(mWindow);
    glfwTerminate();
}

void Window::listen() {
    glfwSetWindowUserPointer(mWindow, this);
    glfwSetKeyCallback(mWindow, [](GLFWwindow* window, int code, int, int action, int) {
        if (const auto key = translateKey(code); key && action != GLFW_REPEAT)
            windowOf(window).mInput.setKey(*key, action == GLFW_PRESS);
    });
    glfwSetCharCallback(mWindow, [](GLFWwindow* window, unsigned int character) {
        windowOf(window).mInput.type(character);
    });
    glfwSetMouseButtonCallback(mWindow, [](GLFWwindow* window, int code, int action, int) {
        if (const auto button = translateButton(code))
            windowOf(window).mInput.setButton(*button, action == GLFW_PRESS);
    });
    glfwSetCursorPosCallback(mWindow, [](GLFWwindow* window, double x, double y) {
        Window& self = windowOf(window);
        self.mInput.movePointer(math::dvec2(x, y) * self.pixelScale());
    });
    glfwSetScrollCallback(mWindow, [](GLFWwindow* window, double, double y) {
        windowOf(window).mInput.turnWheel(y);
    });
    glfwSetWindowFocusCallback(mWindow, [](GLFWwindow* window, int focused) {
        if (!focused)
            windowOf(window).mInput.releaseAll();
    });
}

math::dvec2 Window::pixelScale() const {
    int width = 0;
    int height = 0;
    glfwGetWindowSize(mWindow, &width, &height);
    if (width <= 0 || height <= 0)
        return math::dvec2(1.0);
    return math::dvec2(framebufferSize()) / math::dvec2(width, height);
}

std::vector<std::string> Window::surfaceExtensions() const {
    uint32_t count = 0;
    const char** names = glfwGetRequiredInstanceExtensions(&count);
    return {names, names + count};
}

core::Result<VkSurfaceKHR> Window::createSurface(VkInstance instance) const {
    VkSurfaceKHR surface = VK_NULL_HANDLE;
    if (glfwCreateWindowSurface(instance, mWindow, nullptr, &surface) != VK_SUCCESS)
        return core::makeError("the window takes no pictures: {}", describeProblem());
    return surface;
}

void Window::poll(bool wait) {
    if (wait)
        glfwWaitEventsTimeout(0.1);
    else
        glfwPollEvents();
    readPad();
}

void Window::readPad() {
    Gamepad pad;
    GLFWgamepadstate state;
    if (glfwJoystickIsGamepad(GLFW_JOYSTICK_1) && glfwGetGamepadState(GLFW_JOYSTICK_1, &state)) {
        const auto axis = [&](int index) { return applyDeadZone(double(state.axes[index])); };
        pad.present = true;
        pad.leftStick = {axis(GLFW_GAMEPAD_AXIS_LEFT_X), -axis(GLFW_GAMEPAD_AXIS_LEFT_Y)};
        pad.rightStick = {axis(GLFW_GAMEPAD_AXIS_RIGHT_X), -axis(GLFW_GAMEPAD_AXIS_RIGHT_Y)};
        pad.leftTrigger = 0.5 * double(state.axes[GLFW_GAMEPAD_AXIS_LEFT_TRIGGER]) + 0.5;
        pad.rightTrigger = 0.5 * double(state.axes[GLFW_GAMEPAD_AXIS_RIGHT_TRIGGER]) + 0.5;
        constexpr std::array kButtons = {
            GLFW_GAMEPAD_BUTTON_A,
            GLFW_GAMEPAD_BUTTON_B,
            GLFW_GAMEPAD_BUTTON_X,
            GLFW_GAMEPAD_BUTTON_Y,
            GLFW_GAMEPAD_BUTTON_LEFT_BUMPER,
            GLFW_GAMEPAD_BUTTON_RIGHT_BUMPER,
            GLFW_GAMEPAD_BUTTON_BACK,
            GLFW_GAMEPAD_BUTTON_START};
        static_assert(kButtons.size() == kPadButtonCount);
        for (size_t i = 0; i < kButtons.size(); ++i)
            pad.down.set(i, state.buttons[kButtons[i]] == GLFW_PRESS);
    }
    mInput.setPad(pad);
}

math::uvec2 Window::framebufferSize() const {
    int width = 0;
    int height = 0;
    glfwGetFramebufferSize(mWindow, &width, &height);
    if (width <= 0 || height <= 0 || glfwGetWindowAttrib(mWindow, GLFW_ICONIFIED))
        return math::uvec2(0u);
    return {static_cast<uint32_t>(width), static_cast<uint32_t>(height)};
}

double Window::contentScale() const {
    float x = 1.0f;
    float y = 1.0f;
    glfwGetWindowContentScale(mWindow, &x, &y);
    return std::max(double(std::max(x, y)), 0.5);
}

bool Window::closeRequested() const {
    return glfwWindowShouldClose(mWindow);
}

bool Window::isFullScreen() const {
    return glfwGetWindowMonitor(mWindow) != nullptr;
}

void Window::setFullScreen(bool fullScreen) {
    if (fullScreen == isFullScreen())
        return;
    if (!fullScreen) {
        const Placement& back = mWindowed;
        glfwSetWindowMonitor(mWindow, nullptr, back.x, back.y, back.width, back.height, 0);
        return;
    }
    GLFWmonitor* monitor = findMonitor(mWindow);
    const GLFWvidmode* mode = monitor ? glfwGetVideoMode(monitor) : nullptr;
    if (!mode) // a display without monitors
        return;
    glfwGetWindowPos(mWindow, &mWindowed.x, &mWindowed.y);
    glfwGetWindowSize(mWindow, &mWindowed.width, &mWindowed.height);
    glfwSetWindowMonitor(mWindow, monitor, 0, 0, mode->width, mode->height, mode->refreshRate);
}

void Window::resize(uint32_t width, uint32_t height) {
    glfwSetWindowSize(mWindow, static_cast<int>(width), static_cast<int>(height));
}

void Window::minimise() {
    glfwIconifyWindow(mWindow);
}

void Window::restore() {
    glfwRestoreWindow(mWindow);
}

void Window::setTitle(const std::string& title) {
    glfwSetWindowTitle(mWindow, title.c_str());
}

} // namespace shutter::app
