// Replays input: keys, mouse moves and clicks that go through the X server, as those of a person do.
#pragma once

#include "view/controls.h"

#include <glint/result.h>

#include <array>
#include <cstdint>
#include <deque>
#include <functional>
#include <memory>
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

// The queries of a script to the window itself. Everything else is input.
struct ScriptHost {
    GLFWwindow* window = nullptr;
    const Controls* controls = nullptr;
    std::function<bool()> isComplete;  // nothing is being made, and all samples are there
    std::function<bool()> hasFailed;   // an error is shown
    std::function<void(const std::string&)> drop;
    std::function<Status(const std::string&)> report;  // writes the window's state as JSON
    std::function<std::uint64_t()> frames;
    std::function<void(const std::string&)> detail;  // says which step begins
};

class Script {
public:
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
    static Result<std::unique_ptr<Script>> read(const std::string& file, const ScriptHost& host);
    Script(const Script&) = delete;
    Script& operator=(const Script&) = delete;

    // Goes on, between two frames. Error "window-script" if a step or a part of it fails or takes longer than
    // three minutes.
    Status step();
    bool isDone() const;

    // A part of a step. Returns whether it is complete.
    using Act = std::function<Result<bool>()>;

private:
    Script(std::string file, const ScriptHost& host);
    Status parse(const std::string& text);
    // A line of the file.
    struct Line {
        std::vector<std::string> words;
        std::vector<double> numbers;  // among the words behind the first
        std::string rest;             // the text behind the second word, with its blanks

        // The text behind the first word.
        std::string text() const {
            return words[1] + (rest.empty() ? "" : " " + rest);
        }
    };
    // These add the parts of a step. They return false for lines that are none.
    bool addInput(const Line& line);
    bool addOther(const Line& line);
    bool addWait(const Line& line);
    void addKeys(const Line& line);
    void addDrag(const std::vector<double>& numbers);
    void addWheel(double turns);
    void addChoice(const std::vector<std::string>& words);
    void addText(const std::string& control, const std::string& text, bool isNumber);
    void addSize(int width, int height);
    void addMinimising(bool minimises);
    void addCopy(const std::string& from, const std::string& to);
    void addPicture(const std::string& file);
    // These add single parts.
    void act(Act act);
    void perform(const std::function<void()>& work);
    void waitUntil(const std::function<bool()>& test);
    void pause(double seconds);
    void click();
    void frames(std::uint64_t count);
    void moveTo(double x, double y);
    void button(unsigned number, bool down);
    void key(const std::string& name, bool down);
    void keys(const std::vector<std::string>& names);
    void typeText(const std::string& text);
    void reveal(const std::string& control);
    void clickControl(const std::string& control, bool withControlKey = false);

    std::string file_;
    ScriptHost host_;
    X11Input input_;
    struct Step {
        int line = 0;
        Act act;
    };
    std::deque<Step> steps_;
    int line_ = 0;   // the line that is being parsed
    int shown_ = 0;  // the line that runs
    std::vector<std::string> lines_;
    std::int64_t began_ = 0;
};

}  // namespace glint::view
