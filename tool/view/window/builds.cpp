// Builds of the pictures, and what makes them build again: files and settings.
#include "view/window/window.h"

#include <fmt/format.h>

#include <utility>

namespace glint::view {

void Window::order(std::size_t index, std::span<const std::string> changed) {
    Side& one = *sides_[index];
    one.ordered = one.wanted;
    builder_->start({index, one.wanted, scene_, {changed.begin(), changed.end()}});
}

void Window::pollFiles() {
    if (base::millisecondsSince(polled_) < kPollMs || builder_->isBusy(0)) {
        return;
    }
    polled_ = base::Clock::now();
    if (packageWatch_) {
        const Result<std::shared_ptr<const Package>> package = packageWatch_->poll();
        if (!package) {
            report(package.error());
        } else if (*package) {
            say("the package has changed");
            order(0);
        }
    }
    const std::vector<std::string> changed = watch_.changed();
    if (!changed.empty()) {
        say(changed.front() + " has changed");
        for (std::size_t i = 0; i < kPictures; ++i) {
            if (sides_[i]) {
                order(i, changed);
            }
        }
    }
}

Status Window::takeBuilds() {
    for (const Diagnostic& message : builder_->takeMessages()) {
        report(message);
    }
    for (std::size_t i = 0; i < kPictures; ++i) {
        if (sides_[i] && sides_[i]->loading != nullptr && sides_[i]->picture.isLoading()) {
            continue;
        }
        std::optional<Result<Build>> done;
        if (sides_[i] && sides_[i]->loading != nullptr) {
            done = std::move(*std::exchange(sides_[i]->loading, nullptr));
        } else {
            if (const std::optional<Build> early = builder_->pollEarly(i); early && sides_[i]) {
                finishSamples();
                if (sides_[i]->picture.showEarly(*early)) {
                    ++earlyPackages_;
                    say("the edit is shown as a draft");
                }
            }
            done = builder_->poll(i);
            if (!done || !sides_[i]) {
                continue;
            }
            if (*done && sides_[i]->picture.load(**done)) {
                sides_[i]->loading = std::make_unique<Build>(std::move(**done));
                continue;
            }
        }
        Status installed = *done ? install(i, std::move(**done)) : Status((*done).error());
        sides_[i]->buildFailed = !installed;
        if (installed) {
            opening_.reset();
            error_.reset();
            continue;
        }
        if (!sides_[0]->picture.isReady() && !script_) {
            // Nothing is shown yet, and nobody can correct it here.
            return installed;
        }
        if (const Status taken = sides_[i]->picture.takeBackEarly(); !taken) {
            report(taken.error());
        }
        keepScene();
        fail(installed.error());
    }
    return okStatus();
}

Status Window::install(std::size_t index, Build build) {
    Side& one = *sides_[index];
    if (!one.picture.hasLoaded()) {
        GLINT_TRY_DO(presenter_->waitForFrames());
    }
    finishSamples();
    const bool isOtherScene =
        index == 0 && (!one.picture.isReady() || one.picture.build().scene->path != build.scene->path);
    const bool isUploaded = !one.picture.isReady() || one.picture.build().scene != build.scene;
    const double buildMs = build.readMs + build.compileMs + build.texturesMs;
    const int compiled = build.modulesCompiled;
    const std::vector<base::InputFile> inputs = build.inputs;
    std::vector<Diagnostic> notes;
    const auto [width, height] = pictureExtent();
    const Status installed =
        one.picture.install(std::move(build), width, height, presenter_->submitted() + 1, notes);
    for (const Diagnostic& note : notes) {
        report(note);
    }
    if (!installed) {
        return installed.error();
    }
    one.history.clear();
    if (index == 0) {
        watch_.watch(inputs);
        packageWatch_.reset();
        if (!one.wanted.package.empty()) {
            packageWatch_.emplace(one.wanted.package);
        }
    }
    if (isUploaded) {
        pick_.reset();
    }
    if (isOtherScene) {
        cameraIsNew_ = true;
        orbitDistance_ = 0.0;
        exposureIsNew_ = autoExposure_;
        animationChoice_ = 0;
        const auto& animations = one.picture.scene().animations;
        if (request_.animation == "all") {
            animationChoice_ = static_cast<int>(animations.size());
        }
        for (std::size_t i = 0; i < animations.size(); ++i) {
            if (animations[i].name == request_.animation || std::to_string(i) == request_.animation) {
                animationChoice_ = static_cast<int>(i);
            }
        }
        if (animations.empty() && one.wanted.materials.empty()) {
            poses_ = plays_ = false;
        }
    }
    say(fmt::format("{} modules compiled, {:.0f} ms; {}", compiled, buildMs, one.picture.lastChange()));
    GLINT_TRY_DO(followSettings(index));
    return applyPose();
}

// Applies changed settings to the picture, apart from those that need another build.
Status Window::followSettings(std::size_t index) {
    Side& one = *sides_[index];
    if (!one.picture.isReady()) {
        return okStatus();
    }
    // Until the other build is there, the picture keeps what only that build has.
    if (changeBetween(one.ordered, one.wanted) >= compiler::kChangesUpload) {
        order(index);
    }
    compiler::Settings next = withoutRebuilding(one.picture.build().settings(), one.wanted);
    const auto [width, height] = pictureExtent();
    next.renderer.width = width;
    next.renderer.height = height;
    const std::uint32_t changes = changeBetween(one.picture.settings(), next);
    if (changes == 0) {
        return okStatus();
    }
    if (!builder_->isBusy(index) && !one.buildFailed) {
        error_.reset();
    }
    if (changes != compiler::kChangesFrame) {
        GLINT_TRY_DO(presenter_->waitForFrames());
        finishSamples();
        one.history.clear();
    }
    if (Status changed = one.picture.change(next, width, height); !changed) {
        fail(changed.error());
    }
    wakes_ = 4;
    return okStatus();
}

}  // namespace glint::view
