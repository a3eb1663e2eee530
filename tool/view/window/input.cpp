// Keys, mouse and files, and the changes that they make.
#include "settings/descriptor.h"
#include "view/window/window.h"

#define GLFW_INCLUDE_NONE
#include <fmt/format.h>

#include <GLFW/glfw3.h>
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <imgui.h>

namespace glint::view {

namespace {

namespace fs = std::filesystem;

constexpr double kClickRadius = 3.0;  // window coordinates; farther is a drag
constexpr double kBorderReach = 8.0;  // window coordinates, on either side of a wipe's border
constexpr double kWheelStep = 0.12;   // share of the distance that a step of the wheel goes
constexpr float kExposureStep = 1.0F / 3.0F;

std::string lowerExtension(const fs::path& file) {
    std::string extension = file.extension().string();
    std::ranges::transform(extension, extension.begin(),
                           [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    return extension;
}

}  // namespace

void Window::onKey(int key, int action, int modifiers) {
    wakes_ = 4;
    // A key that is held while the window is busy must not do its work several times. Steps may repeat.
    const bool steps = key == GLFW_KEY_LEFT_BRACKET || key == GLFW_KEY_RIGHT_BRACKET;
    if (action == GLFW_PRESS || (action == GLFW_REPEAT && steps)) {
        keys_.push_back({key, modifiers});
    }
}

void Window::onScroll(double steps) {
    wakes_ = 4;
    scrolled_ += steps;
}

void Window::onDrop(const std::string& file) {
    wakes_ = 4;
    const std::string extension = lowerExtension(file);
    if (showsOutliner_ && side().picture.isReady() && (extension == ".gltf" || extension == ".glb")) {
        addFile(file);
    } else {
        openFile(file);
    }
}

// Adds a file below the selected node.
void Window::addFile(const std::string& file) {
    session::Edit one{.kind = session::EditKind::Add};
    std::error_code error;
    const fs::path whole = fs::absolute(file, error);
    one.file = error ? file : whole.string();
    one.parent = selected_ < 0 ? std::string() : session::nodeLabel(side().picture.scene(), selected_);
    edit(std::move(one));
}

void Window::openFile(const std::string& file) {
    const std::string extension = lowerExtension(file);
    if (extension == ".gltf" || extension == ".glb") {
        opening_ = Opening{scene_, {}, edits_};
        if (file != scene_) {
            edits_.clear();
            selected_ = -1;
        }
        scene_ = file;
        forSides([this](Side& one) {
            opening_->wanted.push_back(one.wanted);
            one.wanted.camera.clear();
            one.wanted.package.clear();
            one.wanted.sceneInFile.clear();
            one.wanted.variant.clear();
        });
        poses_ = plays_ = false;
        time_ = 0.0;
        showTitle();
        say("opening " + file);
    } else if (extension == ".hdr" || extension == ".exr") {
        forSides([&](Side& one) {
            one.wanted.environment = file;
            one.wanted.sky.reset();
        });
        exposureIsNew_ = autoExposure_;
        say("lighting the scene by " + file);
    } else {
        fail(makeError("window-drop", file, "is no scene and no environment map",
                       "drop a .gltf, .glb, .hdr or .exr file"));
        return;
    }
    orderAll();
}

// Goes back to the scene that is shown, because another one could not be opened.
void Window::keepScene() {
    if (!opening_) {
        return;
    }
    scene_ = opening_->scene;
    edits_ = std::move(opening_->edits);
    auto wanted = opening_->wanted.begin();
    for (std::size_t i = 0; i < kPictures; ++i) {
        if (sides_[i] && wanted != opening_->wanted.end()) {
            builder_->cancel(i);
            sides_[i]->loading.reset();
            sides_[i]->picture.cancelLoad();
            sides_[i]->buildFailed = false;
            sides_[i]->wanted = *wanted;
            sides_[i]->ordered = *wanted++;
        }
    }
    opening_.reset();
    showTitle();
}

void Window::showTitle() {
    glfwSetWindowTitle(window_, ("glint view: " + scene_).c_str());
}

void Window::restartPictures() {
    forSides([](Side& one) { one.picture.restart(); });
    wakes_ = 4;
}

void Window::fly(double seconds) {
    const auto isDown = [this](int key) { return glfwGetKey(window_, key) == GLFW_PRESS ? 1.0 : 0.0; };
    if (isDown(GLFW_KEY_LEFT_CONTROL) + isDown(GLFW_KEY_RIGHT_CONTROL) > 0.0) {
        return;
    }
    const double right = isDown(GLFW_KEY_D) - isDown(GLFW_KEY_A);
    const double up = isDown(GLFW_KEY_E) - isDown(GLFW_KEY_Q);
    const double forward = isDown(GLFW_KEY_W) - isDown(GLFW_KEY_S);
    if (right == 0.0 && up == 0.0 && forward == 0.0) {
        return;
    }
    constexpr double kFast = 4.0;
    const double factor = isDown(GLFW_KEY_LEFT_SHIFT) > 0.0 ? kFast : 1.0;
    camera_.fly(right, up, forward, factor * seconds);
    restartPictures();
}

void Window::handleInput(double seconds) {
    const ImGuiIO& io = ImGui::GetIO();
    // Keys belong to a list that is open: Escape closes it and nothing else.
    const bool hasList = ImGui::IsPopupOpen("", ImGuiPopupFlags_AnyPopupId | ImGuiPopupFlags_AnyPopupLevel);
    const bool isTyping = io.WantTextInput || hasList;
    for (const KeyPress& press : keys_) {
        const bool isFunction = press.key >= GLFW_KEY_F1 && press.key <= GLFW_KEY_F25;
        if (!isTyping || isFunction) {
            handleKey(press);
        }
    }
    if (!isTyping) {
        fly(seconds);
    }
    keys_.clear();
    handleMouse();
    scrolled_ = 0.0;
}

void Window::handleMouse() {
    const ImGuiIO& io = ImGui::GetIO();
    const std::array<double, 2> at{io.MousePos.x, io.MousePos.y};
    const double width = area_.width / static_cast<double>(pixelScale_);
    const double height = area_.height / static_cast<double>(pixelScale_);
    const bool isInside = at[0] >= 0.0 && at[1] >= 0.0 && at[0] < width && at[1] < height;
    if (isInside && scrolled_ != 0.0 && !io.WantCaptureMouse) {
        if (flies_) {
            camera_.changeSpeed(std::pow(1.25, scrolled_));
            say(fmt::format("flies {:.3g} times the target's distance a second", camera_.speed()));
        } else {
            camera_.approach(1.0 - std::pow(1.0 - kWheelStep, scrolled_));
            restartPictures();
        }
    }
    if (!drags_) {
        for (int button = 0; button < 3; ++button) {
            if (ImGui::IsMouseClicked(button) && isInside && !io.WantCaptureMouse) {
                drags_ = true;
                dragButton_ = button;
                pressed_ = at;
                mouse_ = at;
                movesBorder_ = shown_ == Shown::Wipe && sides_[1] && button == 0 &&
                               std::abs(at[0] - border_ * width) < kBorderReach;
            }
        }
        return;
    }
    const double right = (at[0] - mouse_[0]) / height;
    const double down = (at[1] - mouse_[1]) / height;
    const bool isClick =
        std::hypot(at[0] - pressed_[0], at[1] - pressed_[1]) <= kClickRadius && !movesBorder_;
    if (!ImGui::IsMouseDown(dragButton_)) {
        drags_ = false;
        if (isClick && dragButton_ == 0) {
            pickAt(at[0], at[1]);
        }
        return;
    }
    if (isClick || (right == 0.0 && down == 0.0)) {
        return;
    }
    mouse_ = at;
    if (movesBorder_) {
        border_ = static_cast<float>(std::clamp(at[0] / width, 0.0, 1.0));
        return;
    }
    if (dragButton_ == 2 || (dragButton_ == 0 && io.KeyShift)) {
        camera_.pan(right, down);
    } else if (dragButton_ == 1 || flies_) {
        camera_.look(0.5 * right, 0.5 * down);
    } else {
        camera_.orbit(right, down);
    }
    restartPictures();
}

void Window::handleKey(const KeyPress& press) {
    const bool control = (press.modifiers & GLFW_MOD_CONTROL) != 0;
    if (control) {
        if (press.key == GLFW_KEY_Q) {
            glfwSetWindowShouldClose(window_, GLFW_TRUE);
        }
        return;
    }
    const auto chooseStrategy = [this](std::size_t index) {
        if (index < package::strategyTable().size()) {
            side().wanted.strategy = package::strategyTable()[index].strategy;
            followPanel();
        }
    };
    switch (press.key) {
        case GLFW_KEY_F1:
            showsHelp_ = !showsHelp_;
            break;
        case GLFW_KEY_ESCAPE:
            showsHelp_ = false;
            pick_.reset();
            wantsShot_ = false;
            break;
        case GLFW_KEY_TAB:
            showsPanel_ = !showsPanel_;
            resized_ = base::Clock::now();
            break;
        case GLFW_KEY_F:
            flies_ = !flies_;
            say(flies_ ? "dragging looks around" : "dragging orbits the target");
            break;
        case GLFW_KEY_HOME:
            cameraIsNew_ = true;
            break;
        case GLFW_KEY_C:
            nextCamera();
            break;
        case GLFW_KEY_SPACE:
            togglePlaying();
            break;
        case GLFW_KEY_P:
        case GLFW_KEY_F12:
            wantsShot_ = true;
            break;
        case GLFW_KEY_X:
            autoExposure_ = true;
            exposureIsNew_ = true;
            break;
        case GLFW_KEY_LEFT_BRACKET:
        case GLFW_KEY_RIGHT_BRACKET:
            autoExposure_ = false;
            exposure_ += press.key == GLFW_KEY_LEFT_BRACKET ? -kExposureStep : kExposureStep;
            break;
        case GLFW_KEY_L:
            if (look_.isPicture()) {
                wantedTab_ = "Views";
            } else {
                chooseLook({});
            }
            break;
        case GLFW_KEY_M:
            divisor_ = divisor_ % 4 + 1;
            break;
        case GLFW_KEY_B:
            compare(sides_[1] == nullptr);
            break;
        case GLFW_KEY_V:
            if (sides_[1]) {
                shown_ = static_cast<Shown>((static_cast<std::uint32_t>(shown_) + 1) % kShownCount);
            }
            break;
        default:
            if (press.key >= GLFW_KEY_1 && press.key <= GLFW_KEY_9) {
                chooseStrategy(static_cast<std::size_t>(press.key - GLFW_KEY_1));
            }
            break;
    }
}

void Window::nextCamera() {
    if (!sides_[0]->picture.isReady()) {
        return;
    }
    const std::size_t count = sides_[0]->picture.scene().cameras.size();
    cameraIndex_ = (cameraIndex_ + 1) % (count + 1);
    const std::string name = cameraIndex_ == count ? "auto" : std::to_string(cameraIndex_);
    forSides([&](Side& one) { one.wanted.camera = name; });
    orbitDistance_ = 0.0;
    cameraIsNew_ = true;
    say("camera " + name);
}

// Shows a view, a layer, or the picture. Missing layers are compiled into the package, as for any setting.
void Window::chooseLook(const Look& look) {
    look_ = look;
    viewedFrame_ = 0;
    lookNote_.clear();
    view_.reset();
    wakes_ = 4;
    Side& one = side();
    if (one.picture.isReady() && one.wanted.package.empty() &&
        askFor(look, one.picture.build(), one.wanted)) {
        followPanel();
    }
}

void Window::togglePlaying() {
    const Picture& picture = sides_[0]->picture;
    if (!picture.isReady() || (picture.scene().animations.empty() && sides_[0]->wanted.materials.empty())) {
        say("the scene has no animation");
        return;
    }
    plays_ = !plays_;
    poses_ = true;
}

void Window::compare(bool on) {
    if (!on) {
        if (presenter_->waitForFrames()) {
            builder_->cancel(1);
            sides_[1].reset();
        }
        edited_ = 0;
        shown_ = Shown::First;
        difference_.clear();
        return;
    }
    sides_[1] = std::make_unique<Side>(*context_);
    sides_[1]->wanted = sides_[0]->wanted;
    reportErrorOf(sides_[1]->picture.edit(edits_, 0, 0));
    shown_ = Shown::Wipe;
    edited_ = 1;
    order(1);
}

void Window::pickAt(double x, double y) {
    // In a wipe, the pixel belongs to the picture that is shown there.
    const bool isSecond =
        sides_[1] && sides_[1]->picture.isReady() &&
        (view_ ? edited_ == 1
               : shown_ == Shown::Second ||
                     (shown_ == Shown::Wipe && x * pixelScale_ > static_cast<double>(border_) * area_.width));
    Picture& picture = sides_[isSecond ? 1 : 0]->picture;
    if (!picture.isReady() || picture.recordedIn() == 0) {
        return;
    }
    const compiler::Settings& settings = picture.settings();
    const auto pixel = [&](double place, int extent, std::uint32_t count) {
        const double share = place * pixelScale_ / extent;
        return std::min(static_cast<std::uint32_t>(share * count), count - 1);
    };
    Result<Pick> picked =
        pickPixel(request_, picture, pixel(x, area_.width, settings.renderer.width),
                  pixel(y, area_.height, settings.renderer.height), static_cast<double>(exposure_));
    if (!picked) {
        report(picked.error());
        return;
    }
    pick_ = std::move(*picked);
    selected_ = pick_->node;
    wantedTab_ = showsOutliner_ ? "Nodes" : "Pixel";
}

}  // namespace glint::view
