// The places of the panels' controls, so that a script can find them as a person would: by their names.
#pragma once

#include <array>
#include <map>
#include <optional>
#include <string>

namespace glint::view {

class Controls {
public:
    struct Place {
        std::array<float, 2> min{};  // window coordinates, also of a control that is scrolled away
        std::array<float, 2> max{};
        std::array<float, 2> clipMin{};  // the part of the window that shows it
        std::array<float, 2> clipMax{};
    };

    void beginFrame() {
        places_.swap(current_);
        current_.clear();
    }
    // Notes the place of ImGui's last item.
    void mark(const std::string& name);
    // Returns the place in the last frame, or no value if the control was not there.
    std::optional<Place> find(const std::string& name) const;

private:
    std::map<std::string, Place> places_;
    std::map<std::string, Place> current_;
};

// Closes the list that is open if Escape is pressed. Call it in the list.
void closeByEscape();

// Draws a text that ends with dots where the line has no room for it.
void fittedText(const std::string& text);

// Shows a text while the mouse is over ImGui's last item.
void tip(const std::string& text);

}  // namespace glint::view
