// Input that goes through the X server, and the picture that it shows. Headers of X define names of Glint as
// macros, so they are included by one source only.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

struct GLFWwindow;

namespace glint::view {

// Each call returns when the server has passed the input on, so that the next look at events finds it.
class X11Input {
public:
    explicit X11Input(GLFWwindow* window);

    // Returns whether the server takes input from programs.
    bool isAvailable() const;
    // Moves the mouse to a pixel of the window.
    void move(double x, double y) const;
    // 1 left, 2 middle, 3 right, 4 wheel up, 5 wheel down.
    void button(unsigned number, bool down) const;
    // Presses a key by its X name. Presses Shift too, where the character needs it. Returns false if the
    // keyboard has no such key.
    bool key(const std::string& name, bool down) const;

    // Does the work of a window manager where there is none; returns false where there is one.
    bool setMinimised(bool minimised) const;

    struct Pixels {
        std::uint32_t width = 0;
        std::uint32_t height = 0;
        std::vector<std::array<std::uint8_t, 3>> pixels;  // row by row from the top
    };
    std::optional<Pixels> picture() const;

private:
    void* display_ = nullptr;
    unsigned long window_ = 0;
};

}  // namespace glint::view
