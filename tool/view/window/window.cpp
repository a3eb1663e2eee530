// The window's start, loop and end.
#include "view/window/window.h"

#include "image/tone.h"
#include "settings/descriptor.h"

#include <glint/measure/observer.h>
#include <glint/session/session.h>

#define GLFW_INCLUDE_NONE
#include <fmt/format.h>

#include <GLFW/glfw3.h>
#include <algorithm>
#include <limits>
#include <utility>

namespace glint::view {

namespace {

constexpr std::size_t kMessages = 200;  // the most that are kept

Window& windowOf(GLFWwindow* window) {
    return *static_cast<Window*>(glfwGetWindowUserPointer(window));
}

// Returns the part of the first screen that windows may cover, in window coordinates.
Presenter::Area workArea() {
    Presenter::Area room{0, 0, std::numeric_limits<int>::max(), std::numeric_limits<int>::max()};
    if (GLFWmonitor* const monitor = glfwGetPrimaryMonitor()) {
        Presenter::Area found;
        glfwGetMonitorWorkarea(monitor, &found.x, &found.y, &found.width, &found.height);
        room = found.width > 0 && found.height > 0 ? found : room;
    }
    return room;
}

Diagnostic windowError(const std::string& message) {
    return makeError("window-open", "", message, "run this where there is a display, or use glint render");
}

}  // namespace

Window::Window(const Request& request) : request_(request), scene_(request.scene) {}

Window::~Window() {
    builder_.reset();
    forSides([](Side& one) { one.picture.cancelLoad(); });
    if (context_) {
        vkDeviceWaitIdle(context_->handles().device);
        request_.closing(*context_);
    }
    driver_ = nullptr;
    for (std::unique_ptr<Side>& one : sides_) {
        one.reset();
    }
    display_.reset();
    interface_.reset();
    presenter_.reset();
    context_.reset();
    if (window_ != nullptr) {
        glfwDestroyWindow(window_);
    }
    glfwTerminate();
}

Status Window::openDevice() {
    HeadlessOptions options = session::deviceOptions(request_.settings);
    std::uint32_t count = 0;
    const char** const extensions = glfwGetRequiredInstanceExtensions(&count);
    if (extensions == nullptr) {
        return windowError("there is no Vulkan driver that shows pictures in windows");
    }
    options.instanceExtensions.assign(extensions, extensions + count);
    options.deviceExtensions = {VK_KHR_SWAPCHAIN_EXTENSION_NAME};
    // Features that packages may need are enabled from the start, if the device has them.
    const HeadlessOptions asked = options;
    std::optional<Result<std::unique_ptr<Context>>> made;
    constexpr unsigned kClock = 1;
    constexpr unsigned kHalf = 2;
    constexpr unsigned kFetch = 4;
    constexpr unsigned kEverything = 7;
    for (unsigned tried :
         {kEverything, kHalf | kClock, kFetch | kClock, kFetch | kHalf, kClock, kHalf, kFetch}) {
        // The validation layers of Debian 12 don't know position fetch.
        tried &= asked.validation == Validation::Off ? kEverything : ~kFetch;
        options.positionFetch = asked.positionFetch || (tried & kFetch) != 0;
        options.shaderFloat16 = asked.shaderFloat16 || (tried & kHalf) != 0;
        options.shaderClock = asked.shaderClock || (tried & kClock) != 0;
        made = Context::createHeadless(options);
        if (*made || made->error().id != "device-features") {
            break;
        }
    }
    if (!*made && made->error().id == "device-features") {
        made = Context::createHeadless(asked);
    }
    if (!*made) {
        return made->error();
    }
    context_ = std::move(**made);
    request_.opened(*context_);
    return okStatus();
}

Status Window::open() {
    glfwInitHint(GLFW_JOYSTICK_HAT_BUTTONS, GLFW_FALSE);
    if (glfwInit() == GLFW_FALSE) {
        const char* text = nullptr;
        glfwGetError(&text);
        return windowError(text != nullptr ? fmt::format("no window can be opened ({})", text)
                                           : std::string("no window can be opened"));
    }
    GLINT_TRY_DO(openDevice());
    showsPanel_ = request_.showsPanel;
    glfwWindowHint(GLFW_CLIENT_API, GLFW_NO_API);
    const int panel = showsPanel_ ? static_cast<int>(kPanelWidth) : 0;
    const Presenter::Area room = workArea();
    const int width = std::min(static_cast<int>(request_.settings.renderer.width) + panel, room.width);
    const int height = std::min(
        static_cast<int>(request_.settings.renderer.height) + static_cast<int>(kStatusHeight), room.height);
    window_ = glfwCreateWindow(width, height, ("glint view: " + scene_).c_str(), nullptr, nullptr);
    if (window_ == nullptr) {
        return windowError("the window could not be opened");
    }
    // A window that fills the screen has no other place.
    if (width == room.width || height == room.height) {
        glfwSetWindowPos(window_, room.x, room.y);
    }
    glfwSetWindowUserPointer(window_, this);
    // Dear ImGui's callbacks, which are set later, call these.
    glfwSetKeyCallback(window_, [](GLFWwindow* window, int key, int, int action, int modifiers) {
        windowOf(window).onKey(key, action, modifiers);
    });
    glfwSetScrollCallback(window_,
                          [](GLFWwindow* window, double, double y) { windowOf(window).onScroll(y); });
    glfwSetCharCallback(window_, [](GLFWwindow* window, unsigned) { windowOf(window).onChange(false); });
    glfwSetMouseButtonCallback(window_,
                               [](GLFWwindow* window, int, int, int) { windowOf(window).onChange(false); });
    glfwSetCursorPosCallback(window_,
                             [](GLFWwindow* window, double, double) { windowOf(window).onChange(false); });
    glfwSetFramebufferSizeCallback(window_,
                                   [](GLFWwindow* window, int, int) { windowOf(window).onChange(true); });
    glfwSetWindowRefreshCallback(window_, [](GLFWwindow* window) { windowOf(window).onChange(false); });
    glfwSetDropCallback(window_, [](GLFWwindow* window, int count, const char** files) {
        for (int i = 0; i < count; ++i) {
            windowOf(window).onDrop(files[i]);
        }
    });
    GLINT_TRY(presenter_, Presenter::create(*context_, window_));
    GLINT_TRY(interface_, Interface::create(*context_, window_, *presenter_));
    GLINT_TRY(display_, Display::create(*context_));
    builder_ = std::make_unique<Builder>(request_, *context_);
    sides_[0] = std::make_unique<Side>(*context_);
    side().wanted = request_.settings;
    autoExposure_ = request_.exposure == "auto";
    if (!autoExposure_) {
        double stops = 0.0;
        compiler::parseReal(request_.exposure, -image::kMaxExposure, image::kMaxExposure, stops);
        exposure_ = static_cast<float>(stops);
    }
    if (!request_.time.empty()) {
        poses_ = true;
        compiler::parseReal(request_.time, 0.0, 1e6, time_);
    }
    plays_ = request_.plays;
    poses_ = poses_ || plays_;
    order(0);
    if (request_.drive) {
        GLINT_TRY(
            driver_,
            request_.drive(
                {window_, &controls_, [this] { return isComplete() && hasWantedSize(); },
                 [this] { return error_.has_value(); }, [this](const std::string& file) { onDrop(file); },
                 [this](const std::string& file) { return writeReport(file); }, [this] { return frames_; },
                 [this](const std::string& text) { request_.observer->detail(text); }}));
        glfwFocusWindow(window_);
    }
    return okStatus();
}

void Window::onChange(bool size) {
    wakes_ = 4;
    if (size) {
        presenter_->sizeChanged();
        resized_ = base::Clock::now();
    }
}

void Window::report(const Diagnostic& message) {
    request_.observer->report(message);
    messages_.push_back(message);
    ++unread_;
    if (messages_.size() > kMessages) {
        messages_.pop_front();
    }
    wakes_ = 4;
}

void Window::fail(const Diagnostic& error) {
    error_ = error;
    report(error);
    status_ = "failed, the picture stays as it was";
}

void Window::say(const std::string& text) {
    status_ = text;
    request_.observer->detail(text);
    wakes_ = 4;
}

Status Window::run() {
    while (glfwWindowShouldClose(window_) == GLFW_FALSE) {
        if (isIdle() && !driver_) {
            glfwWaitEventsTimeout(kPollMs / 1000.0);
        } else {
            glfwPollEvents();
        }
        if (glfwGetWindowAttrib(window_, GLFW_ICONIFIED) == GLFW_TRUE) {
            glfwWaitEventsTimeout(kPollMs / 1000.0);
            ++frames_;
        } else if (!isIdle() || driver_) {
            GLINT_TRY_DO(frame());
        }
        pollFiles();
        GLINT_TRY_DO(takeBuilds());
        if (driver_) {
            GLINT_TRY(const bool isDone, driver_());
            if (isDone) {
                driver_ = nullptr;
            }
        }
        const std::vector<std::string> validation = context_->validationMessages();
        for (; validationSeen_ < validation.size(); ++validationSeen_) {
            messages_.push_back(makeWarning("validation", "", validation[validationSeen_]));
            ++unread_;
        }
    }
    GLINT_TRY_DO(presenter_->waitForFrames());
    return measure::checkValidation(*request_.observer, *context_);
}

Status showWindow(const Request& request) {
    Window window(request);
    GLINT_TRY_DO(window.open());
    return window.run();
}

}  // namespace glint::view
