// Replays input: keys, mouse moves and clicks that go through the X server, as those of a person do.
#pragma once

#include "view/request.h"

#include <glint/result.h>

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

struct GLFWwindow;

namespace glint::testing {

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

// Reads the steps of a file. A line has a word and its arguments; # begins a comment.
//   wait complete            until nothing is made any more and all samples are there
//   wait failed              until an error is shown
//   wait frames N            until N frames were drawn
//   wait control NAME        until it is there
//   pause SECONDS
//   key NAME...              presses keys of X together: key Tab, key ctrl+a
//   hold NAME SECONDS        keeps a key pressed
//   type TEXT
//   move X Y                 in window coordinates
//   click X Y | click NAME   a control by its name
//   drag X Y X Y [BUTTON]    1 left, 2 middle, 3 right
//   wheel N                  up, or down below 0
//   choose NAME WORD...      opens a list and clicks words
//   number NAME TEXT         types a number into a slider
//   enter NAME TEXT          types a text
//   size W H | minimise | restore
//   copy FROM TO             replaces a file
//   drop FILE
//   picture FILE.png         what the X server shows of the window
//   report FILE.json
//   quit
// Errors: those of reading the file, and "window-script" for a line that is none of these.
//
// The result has the error "window-script" if a step or a part of it fails or takes longer than three
// minutes.
Result<view::WindowDriver> readScript(const std::string& file, const view::WindowAccess& access);

}  // namespace glint::testing
