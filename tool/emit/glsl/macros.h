// The macros and constants of a text: what they expand to, and which expressions they decide.
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace glint::compiler {

class Macros {
public:
    // Takes the argument of a #define: name, parameters and body. Line breaks in it count as blanks.
    void define(std::string_view argument);
    // Forgets a macro, or what is defined by a directive that may not count.
    void undefine(std::string_view name);
    bool has(std::string_view name) const {
        return macros_.contains(name);
    }
    // A constant of GLSL whose value is a whole number.
    void setConstant(std::string_view name, std::uint32_t value);

    // Returns the text with its macros replaced, and those in what replaces them.
    std::string expand(std::string_view text) const;
    // Returns the value of an expression of integers and bools, in 32 bits. Returns nothing if the macros and
    // constants do not decide it: it reads a variable, calls a function, or has numbers of another type. One
    // side may decide && and ||.
    std::optional<std::uint32_t> evaluate(std::string_view expression) const;

private:
    struct Macro {
        std::vector<std::string> parameters;
        bool takesArguments = false;
        std::string body;
    };
    // `active`: the macros that are being replaced, which are not replaced again.
    void expandInto(std::string_view text, std::vector<std::string_view>& active, std::string& result) const;

    std::map<std::string, Macro, std::less<>> macros_;
    std::map<std::string, std::uint32_t, std::less<>> constants_;
};

// Returns the name at the start of a #define's or #undef's argument.
std::string_view nameIn(std::string_view argument);

// Parses a whole number as GLSL writes it: "2", "2u", "0x10u".
std::optional<std::uint32_t> numberIn(std::string_view text);

}  // namespace glint::compiler
