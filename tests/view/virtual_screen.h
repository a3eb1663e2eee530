// An X server without a screen.
#pragma once

#include <string>
#include <sys/types.h>

namespace glint::testing {

class VirtualScreen {
public:
    // Starts Xvfb on a free display. isRunning() is false where it is not installed.
    VirtualScreen();
    ~VirtualScreen();
    VirtualScreen(const VirtualScreen&) = delete;
    VirtualScreen& operator=(const VirtualScreen&) = delete;

    bool isRunning() const {
        return !display_.empty();
    }
    // Returns the value of DISPLAY: ":7".
    const std::string& display() const {
        return display_;
    }

private:
    pid_t child_ = -1;
    std::string display_;
};

}  // namespace glint::testing
