#include "view/script.h"

#include "base/clock.h"
#include "base/files.h"
#include "image/image_file.h"

#define GLFW_INCLUDE_NONE
#include <fmt/format.h>

#include <GLFW/glfw3.h>
#include <charconv>
#include <cmath>
#include <filesystem>
#include <optional>
#include <sstream>
#include <system_error>
#include <utility>

namespace glint::view {

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

}  // namespace

Script::Script(std::string file, const ScriptHost& host)
    : file_(std::move(file)), host_(host), input_(host.window) {}

Result<std::unique_ptr<Script>> Script::read(const std::string& file, const ScriptHost& host) {
    GLINT_TRY(const auto bytes, base::readFile(file));
    std::unique_ptr<Script> script(new Script(file, host));
    if (!script->input_.isAvailable()) {
        return scriptError(file, 0, "the X server takes no input from programs (XTEST)");
    }
    GLINT_TRY_DO(script->parse(std::string(base::asText(bytes))));
    return script;
}

void Script::act(Act act) {
    steps_.push_back({line_, std::move(act)});
}

void Script::frames(std::uint64_t count) {
    auto until = std::make_shared<std::optional<std::uint64_t>>();
    act([this, count, until]() -> Result<bool> {
        *until = until->value_or(host_.frames() + count);
        return host_.frames() >= **until;
    });
}

void Script::moveTo(double x, double y) {
    act([this, x, y]() -> Result<bool> {
        input_.move(x, y);
        return true;
    });
    frames(kTaken);
}

void Script::button(unsigned number, bool down) {
    act([this, number, down]() -> Result<bool> {
        input_.button(number, down);
        return true;
    });
    frames(kTaken);
}

void Script::key(const std::string& name, bool down) {
    act([this, name, down]() -> Result<bool> {
        return input_.key(name, down) ? Result<bool>(true)
                                      : makeError("window-script", "", "the keyboard has no key " + name);
    });
    frames(kTaken);
}

void Script::keys(const std::vector<std::string>& names) {
    for (const std::string& name : names) {
        key(name, true);
    }
    for (auto name = names.rbegin(); name != names.rend(); ++name) {
        key(*name, false);
    }
}

void Script::typeText(const std::string& text) {
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
void Script::reveal(const std::string& control) {
    // Lists and scrolled panels need some frames before they stay in place.
    auto last = std::make_shared<std::uint64_t>(0);
    act([this, control, last]() -> Result<bool> {
        *last = *last == 0 ? host_.frames() : *last;
        if (host_.frames() < *last + kSettle) {
            return false;
        }
        const std::optional<Controls::Place> place = host_.controls->find(control);
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

void Script::clickControl(const std::string& control, bool withControlKey) {
    reveal(control);
    act([this, control]() -> Result<bool> {
        const std::optional<Controls::Place> place = host_.controls->find(control);
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
    button(1, true);
    button(1, false);
    if (withControlKey) {
        key("Control_L", false);
    }
}

Status Script::parse(const std::string& text) {
    std::istringstream lines(text);
    for (std::string line; std::getline(lines, line);) {
        ++line_;
        lines_.push_back(line);
        std::istringstream stream(line);
        std::vector<std::string> words;
        for (std::string word; stream >> word && word.front() != '#';) {
            words.push_back(word);
        }
        if (words.empty()) {
            continue;
        }
        // The text after the second word, with its blanks.
        std::string rest;
        if (words.size() > 2) {
            const std::size_t second = line.find(words[1], line.find(words[0]) + words[0].size());
            rest = line.substr(line.find_first_not_of(' ', second + words[1].size()));
        }
        GLINT_TRY_DO(parseLine(words, rest));
    }
    return okStatus();
}

Status Script::parseLine(const std::vector<std::string>& words, const std::string& rest) {
    const std::string& what = words[0];
    const std::size_t count = words.size() - 1;
    std::vector<double> numbers;
    for (std::size_t i = 1; i < words.size(); ++i) {
        if (const std::optional<double> number = numberIn(words[i])) {
            numbers.push_back(*number);
        }
    }
    const auto withArguments = [&](std::size_t wanted) { return count == wanted; };
    if (what == "wait" && count >= 1) {
        if (words[1] == "complete" || words[1] == "failed") {
            frames(kSettle);
            const std::function<bool()> test = words[1] == "failed" ? host_.hasFailed : host_.isComplete;
            act([test]() -> Result<bool> { return test(); });
            return okStatus();
        }
        if (words[1] == "frames" && numbers.size() == 1) {
            frames(static_cast<std::uint64_t>(numbers[0]));
            return okStatus();
        }
        if (words[1] == "control" && count >= 2) {
            act([this, name = rest]() -> Result<bool> { return host_.controls->find(name).has_value(); });
            return okStatus();
        }
    } else if (what == "pause" && numbers.size() == 1) {
        act([until = std::optional<base::Clock::time_point>(),
             ms = 1000.0 * numbers[0]]() mutable -> Result<bool> {
            until = until.value_or(base::Clock::now());
            return base::millisecondsSince(*until) >= ms;
        });
        return okStatus();
    } else if (what == "key" && count >= 1) {
        for (std::size_t i = 1; i < words.size(); ++i) {
            std::vector<std::string> together;
            std::istringstream names(words[i]);
            for (std::string name; std::getline(names, name, '+');) {
                together.push_back(name == "ctrl" ? "Control_L" : name == "shift" ? "Shift_L" : name);
            }
            keys(together);
        }
        return okStatus();
    } else if (what == "hold" && count == 2 && numbers.size() == 1) {
        key(words[1], true);
        act([until = std::optional<base::Clock::time_point>(),
             ms = 1000.0 * numbers[0]]() mutable -> Result<bool> {
            until = until.value_or(base::Clock::now());
            return base::millisecondsSince(*until) >= ms;
        });
        key(words[1], false);
        return okStatus();
    } else if (what == "type" && count >= 1) {
        typeText(words[1] + (rest.empty() ? "" : " " + rest));
        return okStatus();
    } else if (what == "move" && numbers.size() == 2) {
        moveTo(numbers[0], numbers[1]);
        return okStatus();
    } else if (what == "click" && numbers.size() == 2) {
        moveTo(numbers[0], numbers[1]);
        button(1, true);
        button(1, false);
        return okStatus();
    } else if (what == "click" && count >= 1) {
        clickControl(words[1] + (rest.empty() ? "" : " " + rest));
        return okStatus();
    } else if (what == "drag" && (numbers.size() == 4 || numbers.size() == 5)) {
        const auto number = static_cast<unsigned>(numbers.size() == 5 ? numbers[4] : 1.0);
        moveTo(numbers[0], numbers[1]);
        button(number, true);
        constexpr int kParts = 4;
        for (int part = 1; part <= kParts; ++part) {
            const double share = static_cast<double>(part) / kParts;
            moveTo(std::lerp(numbers[0], numbers[2], share), std::lerp(numbers[1], numbers[3], share));
        }
        button(number, false);
        return okStatus();
    } else if (what == "wheel" && numbers.size() == 1) {
        for (int i = 0; i < std::abs(static_cast<int>(numbers[0])); ++i) {
            button(numbers[0] > 0 ? 4 : 5, true);
            button(numbers[0] > 0 ? 4 : 5, false);
        }
        return okStatus();
    } else if (what == "choose" && count >= 2) {
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
        return okStatus();
    } else if (what == "number" && withArguments(2)) {
        clickControl(words[1], true);
        keys({"Control_L", "a"});
        typeText(words[2]);
        keys({"Return"});
        return okStatus();
    } else if (what == "enter" && count >= 2) {
        clickControl(words[1]);
        keys({"Control_L", "a"});
        typeText(rest);
        keys({"Return"});
        return okStatus();
    } else if (what == "size" && numbers.size() == 2) {
        act([this, numbers]() -> Result<bool> {
            glfwSetWindowSize(host_.window, static_cast<int>(numbers[0]), static_cast<int>(numbers[1]));
            return true;
        });
        // Clicks before the window has its size would hit something else.
        act([this, numbers]() -> Result<bool> {
            int width = 0;
            int height = 0;
            glfwGetWindowSize(host_.window, &width, &height);
            return width == static_cast<int>(numbers[0]) && height == static_cast<int>(numbers[1]);
        });
        frames(kSettle);
        return okStatus();
    } else if (what == "minimise" && withArguments(0)) {
        frames(kSettle);
        act([this]() -> Result<bool> {
            if (!input_.setMinimised(true)) {
                glfwIconifyWindow(host_.window);
            }
            return true;
        });
        return okStatus();
    } else if (what == "restore" && withArguments(0)) {
        act([this]() -> Result<bool> {
            if (!input_.setMinimised(false)) {
                glfwRestoreWindow(host_.window);
            }
            glfwFocusWindow(host_.window);
            return true;
        });
        frames(kSettle);
        return okStatus();
    } else if (what == "copy" && withArguments(2)) {
        act([words]() -> Result<bool> {
            std::error_code error;
            std::filesystem::copy_file(words[1], words[2], std::filesystem::copy_options::overwrite_existing,
                                       error);
            return error ? Result<bool>(makeError("window-script", words[2], error.message())) : true;
        });
        return okStatus();
    } else if (what == "drop" && withArguments(1)) {
        act([this, words]() -> Result<bool> {
            host_.drop(words[1]);
            return true;
        });
        frames(kSettle);
        return okStatus();
    } else if (what == "picture" && withArguments(1)) {
        frames(kSettle);
        act([this, words]() -> Result<bool> {
            std::optional<X11Input::Pixels> picture = input_.picture();
            if (!picture) {
                return makeError("window-script", "", "the X server gives no picture of the window");
            }
            const Status written = image::writeImage(
                words[1], image::DisplayImage{picture->width, picture->height, std::move(picture->pixels)});
            return written ? Result<bool>(true) : written.error();
        });
        return okStatus();
    } else if (what == "report" && withArguments(1)) {
        frames(kSettle);
        act([this, words]() -> Result<bool> {
            const Status written = host_.report(words[1]);
            return written ? Result<bool>(true) : written.error();
        });
        return okStatus();
    } else if (what == "quit" && withArguments(0)) {
        act([this]() -> Result<bool> {
            glfwSetWindowShouldClose(host_.window, GLFW_TRUE);
            return true;
        });
        return okStatus();
    }
    return scriptError(file_, line_, "is no step of a script: " + what);
}

bool Script::isDone() const {
    return steps_.empty();
}

Status Script::step() {
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
            return base::millisecondsSince(since) < kMostMs
                       ? okStatus()
                       : Status(scriptError(file_, step.line,
                                            fmt::format("the step is not done after three minutes: {}",
                                                        lines_[static_cast<std::size_t>(step.line) - 1])));
        }
        began_ = 0;
        steps_.pop_front();
    }
    return okStatus();
}

}  // namespace glint::view
