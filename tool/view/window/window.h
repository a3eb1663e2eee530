// The window of glint view: its state, and the changes that its panels make.
#pragma once

#include "base/clock.h"
#include "base/input_watch.h"
#include "view/builder.h"
#include "view/camera_control.h"
#include "view/controls.h"
#include "view/display.h"
#include "view/look.h"
#include "view/picture.h"
#include "view/presenter.h"

#include <glint/package.h>

#include <array>
#include <cstdint>
#include <deque>
#include <memory>
#include <optional>
#include <string>
#include <vector>

struct GLFWwindow;

namespace glint::view {

// These are in window coordinates, at a content scale of 1.
inline constexpr float kPanelWidth = 440.0F;
inline constexpr float kStatusHeight = 26.0F;

// An event of the window's own: those that Dear ImGui takes are left out.
struct KeyPress {
    int key = 0;
    int modifiers = 0;
};

class Window {
public:
    explicit Window(const Request& request);
    ~Window();
    Window(const Window&) = delete;
    Window& operator=(const Window&) = delete;

    Status open();
    Status run();

    // For callbacks of GLFW.
    void onKey(int key, int action, int modifiers);
    void onScroll(double steps);
    void onDrop(const std::string& file);
    void onChange(bool size);

private:
    // A picture with the user's settings for it.
    struct Side {
        explicit Side(Context& context) : picture(context) {}

        Picture picture;
        std::unique_ptr<Build> loading;  // whose scene is on its way to the device; null: none
        compiler::Settings wanted;       // as the panel shows it
        compiler::Settings ordered;      // of the last build that was ordered
        PassHistory history;
        Renderer::Counters counters;
        std::uint64_t timedFrame = 0;  // of the last times that were read
        bool buildFailed = false;      // the last one; the picture is that of a build before it
    };

    // --- window.cpp ---
    static constexpr double kPollMs = 100.0;  // between two looks at the files
    Status openDevice();
    void report(const Diagnostic& message);
    void say(const std::string& text);
    void fail(const Diagnostic& error);
    // Reports the error, if there is one.
    void reportErrorOf(const Status& status) {
        if (!status) {
            report(status.error());
        }
    }
    Side& side() {
        return *sides_[edited_];
    }
    // Visits the sides that are there.
    template <typename Visit>
    void forSides(const Visit& visit) {
        for (const std::unique_ptr<Side>& one : sides_) {
            if (one) {
                visit(*one);
            }
        }
    }

    // --- results.cpp: builds ---
    // `rereads`: files have changed.
    void order(std::size_t side, bool rereads = false);
    void orderAll(bool rereads = false);
    void pollFiles();
    Status takeBuilds();
    Status install(std::size_t side, Build build);
    Status followSettings(std::size_t side);

    // --- frames.cpp ---
    bool isComplete() const;
    bool hasWantedSize() const;
    bool isIdle() const;
    std::array<std::uint32_t, 2> pictureExtent() const;
    Status fitSize();
    Status frame();
    Status drawFrame(const Presenter::Frame& frame);
    bool isLookCurrent() const;
    Status followLook();
    void finishSamples();

    // --- frames.cpp: the camera, and the moment of animations ---
    CameraView cameraView() const;
    double distanceToMiddle(const CameraView& view) const;
    void startCamera();
    void animate(double seconds);
    Status applyPose();

    // --- input.cpp: keys, mouse, files ---
    void handleInput(double seconds);
    void handleKey(const KeyPress& press);
    void handleMouse();
    void restartPictures();
    void fly(double seconds);
    void addFile(const std::string& file);
    void openFile(const std::string& file);
    void keepScene();
    void showTitle();
    void pickAt(double x, double y);
    void compare(bool on);
    void togglePlaying();
    void nextCamera();
    void chooseLook(const Look& look);

    // --- results.cpp: measurements and files ---
    Status measureExposure();
    Status writeShot(const std::string& file, const Look& shown, const LinearImage& image);
    Status saveScreenshot();
    Status measureDifference();
    Status writeReport(const std::string& file);

    // --- outliner.cpp: the tree of nodes, and edits ---
    void edit(session::Edit edit);
    void editNode(session::EditKind kind);
    void dropEdits(const Diagnostic& error);
    void drawOutliner();
    void drawNode(const gltf::Scene& scene, const std::vector<std::vector<int>>& children, int node);
    void drawSelected(const gltf::Scene& scene);
    void drawTransform(const gltf::Scene& scene);
    void drawMaterials(const gltf::Scene& scene);
    void drawLight(const gltf::Scene& scene);
    void drawVariants(const gltf::Scene& scene);

    // --- panels.cpp ---
    void drawInterface();
    void drawSidePanel(float x, float width, float height);
    void drawHead();
    void drawCompare();
    void drawAnimation();
    void drawPixel();
    void drawLooksTab();
    void drawScene();
    void drawMessages();
    void drawStatus(float width, float y, float height);
    void drawHelp();
    void followPanel();
    void drawMarks();

    const Request& request_;
    GLFWwindow* window_ = nullptr;
    std::unique_ptr<Context> context_;
    std::unique_ptr<Presenter> presenter_;
    std::unique_ptr<Interface> interface_;
    std::unique_ptr<Display> display_;
    std::array<std::unique_ptr<Side>, kPictures> sides_;
    std::unique_ptr<Builder> builder_;
    WindowDriver driver_;  // empty: none

    std::string scene_;
    // The scene and settings that are shown while another scene is being opened.
    struct Opening {
        std::string scene;
        std::vector<compiler::Settings> wanted;  // of the sides that are there
        std::vector<session::Edit> edits;
    };
    std::optional<Opening> opening_;
    std::size_t edited_ = 0;  // side
    Shown shown_ = Shown::First;
    float border_ = 0.5F;
    float gain_ = 8.0F;
    std::string difference_;  // numbers, for people
    int divisor_ = 1;         // pixels of the window for one of the picture, each way

    CameraControl camera_;
    bool cameraIsNew_ = true;
    double orbitDistance_ = 0.0;  // metres; 0: not known yet
    bool flies_ = false;
    std::size_t cameraIndex_ = 0;  // of the scene, for the key that goes from one to the next

    bool autoExposure_ = true;
    float exposure_ = 0.0F;
    bool exposureIsNew_ = true;  // it has to be measured
    bool wasComplete_ = false;

    std::vector<std::size_t> animations_;
    int animationChoice_ = 0;  // 0 to n - 1: one; n: all
    bool plays_ = false;
    bool poses_ = false;  // shows a moment rather than the rest pose
    double time_ = 0.0;
    float playSpeed_ = 1.0F;

    Look look_;                          // of the side whose settings are changed
    std::optional<measure::View> view_;  // as it is shown; no value: the picture itself is shown
    std::string lookNote_;               // why it is not shown
    // The inputs of `view_`.
    Look viewedLook_;
    std::size_t viewedSide_ = 0;
    std::uint64_t viewedFrame_ = 0;  // 0: none
    float viewedExposure_ = 0.0F;
    base::Clock::time_point viewed_{};

    std::vector<session::Edit> edits_;  // all that were made, of both sides
    int selected_ = -1;                 // node
    bool showsOutliner_ = false;        // in the last frame; a file that is dropped is added then
    std::string addedFile_;             // as it is typed

    std::optional<Pick> pick_;
    bool wantsShot_ = false;
    int shots_ = 0;

    Controls controls_;
    SettingsPanel settingsPanel_;
    bool showsPanel_ = true;
    bool showsHelp_ = false;
    bool measuresPasses_ = false;
    std::string wantedTab_;
    std::deque<Diagnostic> messages_;
    std::size_t unread_ = 0;
    std::string status_;
    std::optional<Diagnostic> error_;  // of the last build or change
    std::size_t validationSeen_ = 0;

    base::InputWatch watch_;
    std::optional<Package::Watch> packageWatch_;
    base::Clock::time_point polled_{};

    std::vector<KeyPress> keys_;
    double scrolled_ = 0.0;
    bool drags_ = false;
    bool movesBorder_ = false;
    int dragButton_ = 0;
    std::array<double, 2> pressed_{};
    std::array<double, 2> mouse_{};
    int wakes_ = 4;  // frames that are drawn although nothing is to be done
    std::uint64_t frames_ = 0;
    std::uint64_t samples_ = 0;
    base::Clock::time_point lastFrame_ = base::Clock::now();
    base::Clock::time_point resized_ = base::Clock::now();
    std::deque<double> sampleTimes_;  // seconds between samples
    base::Clock::time_point lastSample_ = base::Clock::now();
    base::Clock::time_point start_ = base::Clock::now();
    std::optional<double> firstPictureMs_;

    // The part of the window that shows the picture, in pixels of the framebuffer.
    Presenter::Area area_;
    float pixelScale_ = 1.0F;  // of the framebuffer for one of the window's coordinates
};

}  // namespace glint::view
