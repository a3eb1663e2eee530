// The request to show a window, and the functions that it needs of the command that opens it.
#pragma once

#include "cache/module_cache.h"
#include "resolve/build.h"
#include "settings/settings.h"

#include <glint/context.h>
#include <glint/measure/observer.h>
#include <glint/result.h>

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

struct GLFWwindow;

namespace glint::view {

class Controls;

// An open window, for a program that uses it as a person does (tests/view/script.h).
struct WindowAccess {
    GLFWwindow* window = nullptr;
    const Controls* controls = nullptr;
    std::function<bool()> isComplete;  // nothing is being made, and all samples are there
    std::function<bool()> hasFailed;   // an error is shown
    std::function<void(const std::string&)> drop;
    std::function<Status(const std::string&)> report;  // writes the window's state as JSON
    std::function<std::uint64_t()> frames;
    std::function<void(const std::string&)> detail;  // with --verbose
};
// Is called between two frames, and returns whether it is done.
using WindowDriver = std::function<Result<bool>()>;

// A line of an explanation: a label and a text.
struct Field {
    std::string label;
    std::string text;
};

struct Request {
    std::string scene;            // .gltf or .glb
    compiler::Settings settings;  // `samples` is the number of samples at which a picture is complete
    std::string exposure = "auto";
    std::string time;             // seconds; empty: the rest pose
    std::string animation = "0";  // a name, a number, or "all"
    bool plays = false;           // from the start
    std::string folder = ".";     // of screenshots
    bool showsPanel = true;

    // Gets every message that the window shows. It must outlive the window.
    const measure::Observer* observer = nullptr;
    // The cache of compiled modules; both may be null.
    compiler::ModuleCache* modules = nullptr;
    compiler::CacheStore* store = nullptr;
    // Returns what `glint explain` says of a material, an index into Scene::materials.
    std::function<std::vector<Field>(const compiler::Build&, int)> explain;
    // Called with the device when it is there, and before it goes: the driver's pipelines are kept in a file.
    std::function<void(Context&)> opened;
    std::function<void(Context&)> closing;
    // Makes what uses the window in place of a person. Empty: nothing does.
    std::function<Result<WindowDriver>(const WindowAccess&)> drive{};
};

// Opens the window and returns when it is closed. Errors: "window-open" (no display), "window-surface" (the
// device can't show pictures in it), "validation" (with Settings::validate), those of the device, of reading
// the scene and making its first picture, and of Request::drive.
Status showWindow(const Request& request);

// --- The command line that makes the same picture as the window: glint render with the settings that differ
// from its defaults ---

struct ShotOptions {
    std::string scene;
    std::string output;
    std::string camera;     // the value of --camera; empty: the default
    double exposure = 0.0;  // stops
    std::string time;       // seconds; empty: the rest pose
    std::string animation;  // with `time`: the value of --animation
    std::string view{};     // the value of --view; empty: the picture itself
    std::string layers{};   // the value of --layers, with an `output` that holds layers; empty: none
    std::string edits{};    // the value of --edits; empty: none
};

// Returns the words, from "glint" on. `settings` has the size of the picture and the number of its samples.
std::vector<std::string> shotWords(const compiler::Settings& settings, const ShotOptions& options);

}  // namespace glint::view
