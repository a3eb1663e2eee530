#include "view/script.h"

#include "base/clock.h"
#include "base/files.h"
#include "image/image_file.h"
#include "view/controls.h"

#define GLFW_INCLUDE_NONE
#include <fmt/format.h>

#include <GLFW/glfw3.h>
#include <charconv>
#include <cmath>
#include <deque>
#include <filesystem>
#include <memory>
#include <optional>
#include <sstream>
#include <system_error>
#include <utility>

namespace glint::testing {

namespace {

constexpr double kMostMs = 180'000.0;  // for a part of a step
constexpr std::uint64_t kTaken = 1;    // frames after which the window has taken in an event
constexpr std::uint64_t kSettle = 3;   // frames after which the effect of input is shown

Diagnostic scriptError(const std::string& file, int line, const std::string& message) {
    return makeError("window-script", fmt::format("{}:{}", file, line), message, "correct the script");
}

std::optional<double> numberIn(const std::string& text) {
    double number = 0.0;
    const char* const end = text.data() + text.size();
    const auto parsed = std::from_chars(text.data(), end, number);
    return parsed.ec == std::errc() && parsed.ptr == end ? std::optional(number) : std::nullopt;
}

// Names of keys for characters that a keysym's name does not have as itself.
std::string keyOfCharacter(char c) {
    switch (c) {
        case ' ':
            return "space";
        case '.':
            return "period";
        case ',':
            return "comma";
        case '-':
            return "minus";
        case '/':
            return "slash";
        case '_':
            return "underscore";
        case ':':
            return "colon";
        default:
            return std::string(1, c);
    }
}

class Script {
public:
    Script(std::string file, const view::WindowAccess& access)
        : file_(std::move(file)), host_(access), input_(access.window) {}

    // Reads the steps.
    Status read(const std::string& text) {
        if (!input_.isAvailable()) {
            return scriptError(file_, 0, "the X server takes no input from programs (XTEST)");
        }
        std::istringstream lines(text);
        for (std::string written; std::getline(lines, written);) {
            ++line_;
            lines_.push_back(written);
            std::istringstream stream(written);
            Line line;
            for (std::string word; stream >> word && word.front() != '#';) {
                if (const std::optional<double> number = numberIn(word); number && !line.words.empty()) {
                    line.numbers.push_back(*number);
                }
                line.words.push_back(word);
            }
            if (line.words.empty()) {
                continue;
            }
            if (line.words.size() > 2) {
                const std::size_t second =
                    written.find(line.words[1], written.find(line.words[0]) + line.words[0].size());
                line.rest = written.substr(written.find_first_not_of(' ', second + line.words[1].size()));
            }
            if (!addInput(line) && !addOther(line)) {
                return scriptError(file_, line_, "is no step of a script: " + line.words[0]);
            }
        }
        return okStatus();
    }

    // Goes on, between two frames, and returns whether all steps are done.
    Result<bool> step() {
        while (!steps_.empty()) {
            Step& step = steps_.front();
            if (step.line != shown_) {
                shown_ = step.line;
                host_.detail(
                    fmt::format("step {}: {}", step.line, lines_[static_cast<std::size_t>(step.line) - 1]));
            }
            const std::int64_t now = base::Clock::now().time_since_epoch().count();
            began_ = began_ == 0 ? now : began_;
            const Result<bool> done = step.act();
            if (!done) {
                return scriptError(file_, step.line, toString(done.error()));
            }
            if (!*done) {
                const base::Clock::time_point since{base::Clock::duration(began_)};
                if (base::millisecondsSince(since) < kMostMs) {
                    return false;
                }
                return scriptError(file_, step.line,
                                   fmt::format("the step is not done after three minutes: {}",
                                               lines_[static_cast<std::size_t>(step.line) - 1]));
            }
            began_ = 0;
            steps_.pop_front();
        }
        return true;
    }

    // A part of a step. Returns whether it is complete.
    using Act = std::function<Result<bool>()>;

private:
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
    bool addInput(const Line& line) {
        const std::string& what = line.words[0];
        const std::vector<double>& numbers = line.numbers;
        const std::size_t count = line.words.size() - 1;
        if (what == "key" && count >= 1) {
            addKeys(line);
        } else if (what == "hold" && count == 2 && numbers.size() == 1) {
            key(line.words[1], true);
            pause(numbers[0]);
            key(line.words[1], false);
        } else if (what == "type" && count >= 1) {
            typeText(line.text());
        } else if (what == "move" && numbers.size() == 2) {
            moveTo(numbers[0], numbers[1]);
        } else if (what == "click" && numbers.size() == 2) {
            moveTo(numbers[0], numbers[1]);
            click();
        } else if (what == "click" && count >= 1) {
            clickControl(line.text());
        } else if (what == "drag" && (numbers.size() == 4 || numbers.size() == 5)) {
            addDrag(numbers);
        } else if (what == "wheel" && numbers.size() == 1) {
            addWheel(numbers[0]);
        } else if (what == "choose" && count >= 2) {
            addChoice(line.words);
        } else if (what == "number" && count == 2) {
            addText(line.words[1], line.words[2], true);
        } else if (what == "enter" && count >= 2) {
            addText(line.words[1], line.rest, false);
        } else {
            return false;
        }
        return true;
    }

    bool addOther(const Line& line) {
        const std::string& what = line.words[0];
        const std::vector<std::string>& words = line.words;
        const std::size_t count = words.size() - 1;
        if (what == "wait" && count >= 1) {
            return addWait(line);
        }
        if (what == "pause" && line.numbers.size() == 1) {
            pause(line.numbers[0]);
        } else if (what == "size" && line.numbers.size() == 2) {
            addSize(static_cast<int>(line.numbers[0]), static_cast<int>(line.numbers[1]));
        } else if ((what == "minimise" || what == "restore") && count == 0) {
            addMinimising(what == "minimise");
        } else if (what == "copy" && count == 2) {
            addCopy(words[1], words[2]);
        } else if (what == "drop" && count == 1) {
            perform([this, file = words[1]] { host_.drop(file); });
            frames(kSettle);
        } else if (what == "picture" && count == 1) {
            addPicture(words[1]);
        } else if (what == "report" && count == 1) {
            frames(kSettle);
            act([this, file = words[1]]() -> Result<bool> {
                GLINT_TRY_DO(host_.report(file));
                return true;
            });
        } else if (what == "quit" && count == 0) {
            perform([this] { glfwSetWindowShouldClose(host_.window, GLFW_TRUE); });
        } else {
            return false;
        }
        return true;
    }

    bool addWait(const Line& line) {
        const std::string& what = line.words[1];
        if (what == "complete" || what == "failed") {
            frames(kSettle);
            waitUntil(what == "failed" ? host_.hasFailed : host_.isComplete);
        } else if (what == "frames" && line.numbers.size() == 1) {
            frames(static_cast<std::uint64_t>(line.numbers[0]));
        } else if (what == "control" && line.words.size() > 2) {
            waitUntil([this, name = line.rest] { return host_.controls->find(name).has_value(); });
        } else {
            return false;
        }
        return true;
    }

    void addKeys(const Line& line) {
        for (std::size_t i = 1; i < line.words.size(); ++i) {
            std::vector<std::string> together;
            std::istringstream names(line.words[i]);
            for (std::string name; std::getline(names, name, '+');) {
                together.push_back(name == "ctrl" ? "Control_L" : name == "shift" ? "Shift_L" : name);
            }
            keys(together);
        }
    }

    void addDrag(const std::vector<double>& numbers) {
        const auto number = static_cast<unsigned>(numbers.size() == 5 ? numbers[4] : 1.0);
        moveTo(numbers[0], numbers[1]);
        button(number, true);
        constexpr int kParts = 4;
        for (int part = 1; part <= kParts; ++part) {
            const double share = static_cast<double>(part) / kParts;
            moveTo(std::lerp(numbers[0], numbers[2], share), std::lerp(numbers[1], numbers[3], share));
        }
        button(number, false);
    }

    void addWheel(double turns) {
        const unsigned wheel = turns > 0 ? 4 : 5;
        for (int i = 0; i < std::abs(static_cast<int>(turns)); ++i) {
            button(wheel, true);
            button(wheel, false);
        }
    }

    void addChoice(const std::vector<std::string>& words) {
        clickControl(words[1]);
        for (std::size_t i = 2; i < words.size(); ++i) {
            clickControl(words[1] + "=" + words[i]);
        }
        act([this, first = words[1] + "=" + words[2]]() -> Result<bool> {
            if (host_.controls->find(first)) {
                // A list of several words stays open.
                input_.key("Escape", true);
            }
            return true;
        });
        frames(kSettle);
        key("Escape", false);
    }

    void addText(const std::string& control, const std::string& text, bool isNumber) {
        clickControl(control, isNumber);
        keys({"Control_L", "a"});
        typeText(text);
        keys({"Return"});
    }

    void addSize(int width, int height) {
        perform([this, width, height] { glfwSetWindowSize(host_.window, width, height); });
        // Clicks before the window has its size would hit something else.
        waitUntil([this, width, height] {
            int nowWide = 0;
            int nowHigh = 0;
            glfwGetWindowSize(host_.window, &nowWide, &nowHigh);
            return nowWide == width && nowHigh == height;
        });
        frames(kSettle);
    }

    void addMinimising(bool minimises) {
        if (minimises) {
            frames(kSettle);
        }
        perform([this, minimises] {
            if (!input_.setMinimised(minimises)) {
                (minimises ? glfwIconifyWindow : glfwRestoreWindow)(host_.window);
            }
            if (!minimises) {
                glfwFocusWindow(host_.window);
            }
        });
        if (!minimises) {
            frames(kSettle);
        }
    }

    void addCopy(const std::string& from, const std::string& to) {
        act([from, to]() -> Result<bool> {
            std::error_code error;
            std::filesystem::copy_file(from, to, std::filesystem::copy_options::overwrite_existing, error);
            return error ? Result<bool>(makeError("window-script", to, error.message())) : true;
        });
    }

    void addPicture(const std::string& file) {
        frames(kSettle);
        act([this, file]() -> Result<bool> {
            std::optional<X11Input::Pixels> picture = input_.picture();
            if (!picture) {
                return makeError("window-script", "", "the X server gives no picture of the window");
            }
            GLINT_TRY_DO(image::writeImage(
                file, image::DisplayImage{picture->width, picture->height, std::move(picture->pixels)}));
            return true;
        });
    }

    // These add single parts.
    void act(Act act) {
        steps_.push_back({line_, std::move(act)});
    }

    void perform(const std::function<void()>& work) {
        act([work]() -> Result<bool> {
            work();
            return true;
        });
    }

    void waitUntil(const std::function<bool()>& test) {
        act([test]() -> Result<bool> { return test(); });
    }

    void pause(double seconds) {
        act([until = std::optional<base::Clock::time_point>(),
             ms = 1000.0 * seconds]() mutable -> Result<bool> {
            until = until.value_or(base::Clock::now());
            return base::millisecondsSince(*until) >= ms;
        });
    }

    void click() {
        button(1, true);
        button(1, false);
    }

    void frames(std::uint64_t count) {
        auto until = std::make_shared<std::optional<std::uint64_t>>();
        act([this, count, until]() -> Result<bool> {
            *until = until->value_or(host_.frames() + count);
            return host_.frames() >= **until;
        });
    }

    void moveTo(double x, double y) {
        perform([this, x, y] { input_.move(x, y); });
        frames(kTaken);
    }

    void button(unsigned number, bool down) {
        perform([this, number, down] { input_.button(number, down); });
        frames(kTaken);
    }

    void key(const std::string& name, bool down) {
        act([this, name, down]() -> Result<bool> {
            return input_.key(name, down) ? Result<bool>(true)
                                          : makeError("window-script", "", "the keyboard has no key " + name);
        });
        frames(kTaken);
    }

    void keys(const std::vector<std::string>& names) {
        for (const std::string& name : names) {
            key(name, true);
        }
        for (auto name = names.rbegin(); name != names.rend(); ++name) {
            key(*name, false);
        }
    }

    void typeText(const std::string& text) {
        // Characters queue up, so that no frame has to pass between two of them.
        act([this, text]() -> Result<bool> {
            for (const char c : text) {
                const std::string name = keyOfCharacter(c);
                if (!input_.key(name, true) || !input_.key(name, false)) {
                    return makeError("window-script", "", "the keyboard has no key " + name);
                }
            }
            return true;
        });
        frames(kTaken);
    }

    // Turns the wheel until the control can be seen.
    void reveal(const std::string& control) {
        // Lists and scrolled panels need some frames before they stay in place.
        auto last = std::make_shared<std::uint64_t>(0);
        act([this, control, last]() -> Result<bool> {
            *last = *last == 0 ? host_.frames() : *last;
            if (host_.frames() < *last + kSettle) {
                return false;
            }
            const std::optional<view::Controls::Place> place = host_.controls->find(control);
            if (!place) {
                return false;
            }
            const float middle = 0.5F * (place->min[1] + place->max[1]);
            const bool isAbove = middle < place->clipMin[1] + 4.0F;
            if (!isAbove && middle <= place->clipMax[1] - 4.0F) {
                return true;
            }
            input_.move(0.5F * (place->clipMin[0] + place->clipMax[0]),
                        0.5F * (place->clipMin[1] + place->clipMax[1]));
            const unsigned wheel = isAbove ? 4 : 5;
            input_.button(wheel, true);
            input_.button(wheel, false);
            *last = host_.frames();
            return false;
        });
    }

    void clickControl(const std::string& control, bool withControlKey = false) {
        reveal(control);
        act([this, control]() -> Result<bool> {
            const std::optional<view::Controls::Place> place = host_.controls->find(control);
            if (!place) {
                return false;
            }
            input_.move(0.5F * (place->min[0] + place->max[0]), 0.5F * (place->min[1] + place->max[1]));
            return true;
        });
        frames(kTaken);
        if (withControlKey) {
            key("Control_L", true);
        }
        click();
        if (withControlKey) {
            key("Control_L", false);
        }
    }

    std::string file_;
    view::WindowAccess host_;
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

}  // namespace

Result<view::WindowDriver> readScript(const std::string& file, const view::WindowAccess& access) {
    GLINT_TRY(const auto bytes, base::readFile(file));
    const auto script = std::make_shared<Script>(file, access);
    GLINT_TRY_DO(script->read(std::string(base::asText(bytes))));
    return view::WindowDriver([script] { return script->step(); });
}

}  // namespace glint::testing
