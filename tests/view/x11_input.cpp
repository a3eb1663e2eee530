#include "view/script.h"

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>
#include <X11/Xutil.h>
#include <X11/extensions/XTest.h>
#include <cmath>

// These are declarations of glfw3native.h, which itself needs the headers of further X extensions.
extern "C" Display* glfwGetX11Display(void);
extern "C" Window glfwGetX11Window(GLFWwindow* window);

namespace glint::testing {

namespace {

Display* displayOf(void* display) {
    return static_cast<Display*>(display);
}

}  // namespace

X11Input::X11Input(GLFWwindow* window) : display_(glfwGetX11Display()), window_(glfwGetX11Window(window)) {}

bool X11Input::isAvailable() const {
    int event = 0;
    int error = 0;
    int major = 0;
    int minor = 0;
    return display_ != nullptr &&
           XTestQueryExtension(displayOf(display_), &event, &error, &major, &minor) != False;
}

void X11Input::move(double x, double y) const {
    Display* const display = displayOf(display_);
    Window child = 0;
    int rootX = 0;
    int rootY = 0;
    XTranslateCoordinates(display, window_, DefaultRootWindow(display), static_cast<int>(std::lround(x)),
                          static_cast<int>(std::lround(y)), &rootX, &rootY, &child);
    XTestFakeMotionEvent(display, -1, rootX, rootY, CurrentTime);
    XSync(display, False);
}

void X11Input::button(unsigned number, bool down) const {
    XTestFakeButtonEvent(displayOf(display_), number, down ? True : False, CurrentTime);
    XSync(displayOf(display_), False);
}

bool X11Input::key(const std::string& name, bool down) const {
    Display* const display = displayOf(display_);
    const KeySym symbol = XStringToKeysym(name.c_str());
    const KeyCode code = symbol == NoSymbol ? KeyCode{0} : XKeysymToKeycode(display, symbol);
    if (code == 0) {
        return false;
    }
    int count = 0;
    KeySym* const symbols = XGetKeyboardMapping(display, code, 1, &count);
    const bool isShifted = count > 1 && symbols[0] != symbol && symbols[1] == symbol;
    XFree(symbols);
    const KeyCode shift = XKeysymToKeycode(display, XK_Shift_L);
    if (isShifted && down) {
        XTestFakeKeyEvent(display, shift, True, CurrentTime);
    }
    XTestFakeKeyEvent(display, code, down ? True : False, CurrentTime);
    if (isShifted && !down) {
        XTestFakeKeyEvent(display, shift, False, CurrentTime);
    }
    XSync(display, False);
    return true;
}

bool X11Input::setMinimised(bool minimised) const {
    Display* const display = displayOf(display_);
    const Atom managed = XInternAtom(display, "_NET_SUPPORTING_WM_CHECK", True);
    Atom type = 0;
    int format = 0;
    unsigned long count = 0;
    unsigned long rest = 0;
    unsigned char* data = nullptr;
    if (managed != 0 &&
        XGetWindowProperty(display, DefaultRootWindow(display), managed, 0, 1, False, AnyPropertyType, &type,
                           &format, &count, &rest, &data) == Success) {
        XFree(data);
        if (count > 0) {
            return false;
        }
    }
    // Inter-Client Communication Conventions Manual, section 4.1.3.1: the state, and the icon's window.
    const long state[] = {minimised ? IconicState : NormalState, 0};
    const Atom name = XInternAtom(display, "WM_STATE", False);
    if (minimised) {
        XUnmapWindow(display, window_);
    } else {
        XMapWindow(display, window_);
    }
    XChangeProperty(display, window_, name, name, 32, PropModeReplace,
                    reinterpret_cast<const unsigned char*>(state), 2);
    XSync(display, False);
    return true;
}

std::optional<X11Input::Pixels> X11Input::picture() const {
    Display* const display = displayOf(display_);
    XWindowAttributes attributes{};
    XGetWindowAttributes(display, window_, &attributes);
    XImage* const image = XGetImage(display, window_, 0, 0, static_cast<unsigned>(attributes.width),
                                    static_cast<unsigned>(attributes.height), AllPlanes, ZPixmap);
    if (image == nullptr) {
        return std::nullopt;
    }
    Pixels result{
        static_cast<std::uint32_t>(attributes.width), static_cast<std::uint32_t>(attributes.height), {}};
    for (int y = 0; y < attributes.height; ++y) {
        for (int x = 0; x < attributes.width; ++x) {
            const unsigned long pixel = XGetPixel(image, x, y);
            result.pixels.push_back({static_cast<std::uint8_t>(pixel >> 16U & 0xFFU),
                                     static_cast<std::uint8_t>(pixel >> 8U & 0xFFU),
                                     static_cast<std::uint8_t>(pixel & 0xFFU)});
        }
    }
    XDestroyImage(image);
    return result;
}

}  // namespace glint::testing
