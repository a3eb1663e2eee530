#include "cli/render/frames.h"

#include "base/clock.h"
#include "image/image_file.h"
#include "image/tone.h"

#include <glint/measure/views.h>
#include <glint/session/live_scene.h>

#include <algorithm>
#include <utility>

namespace glint::cli {

namespace {

// Renders picture after picture with one scene on the device and one renderer.
class FrameLoop {
public:
    FrameLoop(const FrameSetup& setup, gltf::Scene& scene, RenderReport& report)
        : setup_(setup),
          options_(session::rendererOptions(setup.settings)),
          scene_(scene),
          report_(report),
          camera_(setup.camera),
          animations_(setup.movement ? setup.movement->animations : std::vector<std::size_t>()) {}

    // The scene is uploaded in the pose of the first moment, before all edits.
    Status start(Context& context, std::shared_ptr<const Package> package, session::SceneViewData data) {
        if (setup_.movement) {
            GLINT_TRY_DO(pose(0, data));
            data.moves = setup_.movement->seconds.size() > 1;
        }
        if (!setup_.edits.edits.empty()) {
            session::makeEditable(*package, data);
        }
        const base::Clock::time_point begin = base::Clock::now();
        GLINT_TRY(device_, session::DeviceScene::upload(context, std::move(package), std::move(data)));
        if (device_.data.editable) {
            live_.emplace(*device_.package, *device_.gpu, device_.data, scene_,
                          setup_.settings.compile.plan.keys.keptLobes);
        }
        const base::Clock::time_point onDevice = base::Clock::now();
        report_.start.uploadMs = base::millisecondsBetween(begin, onDevice);
        GLINT_TRY(renderer_, device_.makeRenderer(context, options_));
        report_.start.rendererMs = base::millisecondsSince(onDevice);
        return describe();
    }

    // Makes the edits before a frame, and moves the scene on the device to its moment. The upload has that of
    // the first frame.
    Status advance(std::size_t moment, FrameReport& frame) {
        const base::Clock::time_point begin = base::Clock::now();
        GLINT_TRY_DO(edit(frame));
        const bool isUploaded = moment == 0 && frame.edits == 0;
        if (!isUploaded) {
            GLINT_TRY_DO(pose(moment, device_.data));
        }
        // Once for all pictures: a sequence would flicker otherwise.
        if (moment == 0) {
            sky_ = session::chooseSky(setup_.settings, scene_, device_.data);
            report_.sky = setup_.environment == nullptr ? std::optional(sky_) : std::nullopt;
        }
        if (isUploaded) {
            return okStatus();
        }
        frame.poseMs = base::millisecondsSince(begin);
        MotionView motion = live_ ? live_->motion() : device_.data.motion();
        motion.builds = setup_.movement ? setup_.movement->builds : MotionView::Builds::ByRule;
        const base::Clock::time_point updated = base::Clock::now();
        GLINT_TRY_DO(device_.gpu->updateAndWait(motion));
        frame.updateMs = base::millisecondsSince(updated);
        GLINT_TRY(frame.motion, device_.gpu->motion());
        return okStatus();
    }

    // `frame.seconds` is the time that materials follow.
    Result<LinearImage> render(FrameReport& frame) {
        // Reasons that are certain before the picture is made save the time that it takes.
        if (!warned_) {
            warn(session::nothingSeen(scene_, device_.data, camera_));
        }
        FrameOptions options = session::frameOptions(setup_.settings, camera_.view, sky_, setup_.environment);
        options.timing = Timing::Passes;
        options.time = static_cast<float>(frame.seconds);
        options.seed = report_.seed;
        const base::Clock::time_point begin = base::Clock::now();
        const bool countsHits = !setup_.arguments.profileOutput.empty();
        const auto afterSample = [&] {
            if (!std::exchange(begun_, true)) {
                report_.start.firstSampleMs = base::millisecondsSince(begin);
            }
            const std::size_t pictures = setup_.movement ? setup_.movement->seconds.size() : 1;
            if (setup_.progress) {
                setup_.progress(++samplesDone_, pictures * report_.samples);
            }
            return countsHits ? addHits() : okStatus();
        };
        Result<LinearImage> image = renderer_->render(options, report_.samples, afterSample);
        frame.renderMs = base::millisecondsSince(begin);
        report_.renderMs += frame.renderMs;
        if (!image) {
            return image;
        }
        GLINT_TRY_DO(measure(frame));
        if (!warned_) {
            GLINT_TRY(const auto surfaces, renderer_->readSurfaces());
            if (std::ranges::all_of(surfaces, [](std::uint8_t isSurface) { return isSurface == 0; })) {
                warn(session::nothingSeen(scene_, device_.data, camera_, true));
            }
        }
        return setup_.arguments.denoise ? denoised(*image, *renderer_) : std::move(image);
    }

    // Returns the layers of the last picture, for a file that has room for them.
    Result<std::vector<image::ExrLayer>> layersFor(const std::string& file) {
        std::vector<image::ExrLayer> layers;
        const Result<image::ImageFormat> format = image::imageFormat(file);
        if (!format || *format != image::ImageFormat::Exr) {
            return layers;
        }
        for (const Renderer::LayerImage& layer : renderer_->layers()) {
            GLINT_TRY(auto values, renderer_->readLayer(layer.name));
            layers.push_back({std::string(layer.name), std::string(layer.info->channels),
                              layer.info->format == package::LayerInfo::Format::Half4, std::move(values)});
        }
        return layers;
    }

    // Draws the view of the last picture.
    Result<measure::View> drawView(const LinearImage& picture) {
        measure::ViewInput input;
        input.samples = report_.samples;
        input.dispatchesCases = package::infoOf(options_.strategy).dispatchesCases;
        input.package = device_.package.get();
        input.scene = device_.data.packageScene;
        for (const materials::Material& material : scene_.materials) {
            input.materialNames.push_back(material.name);
            input.model = &material.model();
        }
        input.picture = &picture;
        input.reference = setup_.reference;
        return measure::makeView(*measure::parseView(setup_.arguments.view), *renderer_, std::move(input));
    }

    // Returns the exposure for the surfaces of the last picture.
    Result<double> exposureOf(const LinearImage& image) {
        GLINT_TRY(const auto surfaces, renderer_->readSurfaces());
        return image::automaticExposure(image, surfaces);
    }

private:
    // Reports what is on the device.
    Status describe() {
        const Package& package = *device_.package;
        report_.sceneStatistics = device_.gpu->statistics();
        // The effect whose rays may end on the screen; there is one of Glint's own.
        const std::uint32_t onScreen = package.shape().effects.screenStarts;
        onScreen_ = onScreen & (0U - onScreen);
        report_.tracer = std::string(package::nameOf(renderer_->tracer()));
        if ((options_.strategy & package::orderedStrategies()) != 0) {
            report_.ordering = std::string(package::nameOf(renderer_->ordering()));
        }
        report_.pipelines.making = renderer_->pipelineMaking();
        report_.footprint = renderer_->footprint();
        report_.pipelines.count = report_.footprint.pipelines;
        if (options_.pipelineStatistics) {
            GLINT_TRY(report_.pipelines.statistics, renderer_->pipelineStatistics());
        }
        report_.memory = {renderer_->memory(), device_.gpu->memory(), report_.footprint.allocatedBytes,
                          device_.gpu->allocatedBytes(), renderer_->bands()};
        report_.hasDetails = !setup_.arguments.stats.empty();
        report_.countsLight = options_.countsLight;
        report_.traffic.shape = trafficShape(package, options_);
        report_.traffic.shape.binsRays = setup_.settings.frame.binning != FrameOptions::Binning::None;
        return okStatus();
    }

    // Makes the edits that are due before a frame; without a sequence these are all.
    Status edit(FrameReport& frame) {
        const std::vector<session::Edit>& edits = setup_.edits.edits;
        const bool isSequence = setup_.movement && setup_.movement->isSequence;
        for (; edited_ < edits.size() && (!isSequence || edits[edited_].frame <= frame.frame); ++edited_) {
            const session::Edit& edit = edits[edited_];
            const std::size_t known = scene_.animations.size();
            GLINT_TRY([[maybe_unused]] const int node, session::applyEdit(edit, setup_.edits.files, scene_));
            if (edit.kind == session::EditKind::Add) {
                session::addTextures(setup_.edits.textures.find(edit.file)->second, device_.data);
            }
            // The file plays its first animation, or all of them, as the scene does.
            const std::size_t last =
                setup_.arguments.motion.animation == "all" ? scene_.animations.size() : known + 1;
            for (std::size_t i = known; i < std::min(last, scene_.animations.size()); ++i) {
                animations_.push_back(i);
            }
            ++frame.edits;
        }
        return okStatus();
    }

    // Takes a moment of the movement, or the rest pose.
    Status pose(std::size_t moment, session::SceneViewData& data) {
        session::moveTo(setup_.movement
                            ? std::optional(session::Moment{animations_, setup_.movement->seconds[moment]})
                            : std::nullopt,
                        scene_);
        if (live_) {
            GLINT_TRY_DO(live_->follow(scene_));
            for (const Diagnostic& note : live_->takeNotes()) {
                setup_.console.report(note);
            }
        } else {
            session::poseSceneView(scene_, data);
        }
        if (session::framesEverything(scene_, setup_.arguments.camera)) {
            return okStatus();  // that one stands still
        }
        GLINT_TRY(camera_, session::chooseCameraAround(scene_, session::Bounds{}, setup_.arguments.camera,
                                                       setup_.aspect));
        return okStatus();
    }

    // Once is enough for all pictures.
    void warn(const std::optional<Diagnostic>& warning) {
        if (warning) {
            warned_ = true;
            setup_.console.report(*warning);
        }
    }

    Status addHits() {
        GLINT_TRY(const auto counters, renderer_->counters());
        report_.addHits(counters);
        return okStatus();
    }

    // Collects the times and counts of the last sample.
    Status measure(FrameReport& frame) {
        GLINT_TRY(auto passes, renderer_->timings());
        GLINT_TRY(auto counters, renderer_->counters());
        for (const PassTiming& pass : passes) {
            frame.deviceMs += pass.milliseconds;
        }
        report_.passes = std::move(passes);
        report_.counters = std::move(counters);
        report_.traffic.counts = trafficCounts(report_.counters, report_.traffic.shape,
                                               static_cast<double>(report_.width) * report_.height);
        report_.textures.levels.clear();
        for (const std::uint32_t level : report_.counters.textureLevels) {
            const bool isRead = level != Renderer::Counters::kLevelNotRead;
            report_.textures.levels.push_back(isRead ? std::optional(level) : std::nullopt);
        }
        if (!setup_.arguments.coverage.empty()) {
            GLINT_TRY(report_.paths, renderer_->readCoverage(onScreen_));
        }
        return okStatus();
    }

    const FrameSetup& setup_;
    RendererOptions options_;
    gltf::Scene& scene_;
    RenderReport& report_;
    session::CameraChoice camera_;
    std::vector<std::size_t> animations_;  // that play
    std::size_t edited_ = 0;               // edits that were made
    std::size_t samplesDone_ = 0;          // of all pictures
    session::SkyChoice sky_;
    package::Effect onScreen_ = 0;  // for --coverage
    session::DeviceScene device_;
    std::optional<session::LiveScene> live_;  // with edits
    std::unique_ptr<Renderer> renderer_;
    bool begun_ = false;   // a sample is complete
    bool warned_ = false;  // a picture shows nothing
};

// Writes the picture of a frame, or its view.
Status write(FrameLoop& loop, const FrameSetup& setup, const FrameReport& frame, const LinearImage& picture,
             RenderReport& report) {
    if (!setup.arguments.view.empty()) {
        GLINT_TRY(report.view, loop.drawView(picture));
        return image::writeImage(frame.image, measure::withLegend(*report.view));
    }
    GLINT_TRY(const auto layers, loop.layersFor(frame.image));
    return image::writeImage(frame.image, picture, report.exposure, layers);
}

}  // namespace

Status renderFrames(Context& context, std::shared_ptr<const Package> package, const FrameSetup& setup,
                    gltf::Scene& scene, session::SceneViewData data,
                    const std::function<Result<bool>()>& accept, RenderReport& report) {
    FrameLoop loop(setup, scene, report);
    GLINT_TRY_DO(loop.start(context, std::move(package), std::move(data)));
    const Movement still{.seconds = {0.0}};
    const Movement& movement = setup.movement ? *setup.movement : still;
    for (std::size_t i = 0; i < movement.seconds.size(); ++i) {
        FrameReport frame;
        frame.frame = movement.firstFrame + static_cast<std::int64_t>(i);
        frame.seconds = movement.seconds[i];
        const std::string& output = setup.arguments.output;
        frame.image = movement.isSequence ? numberedFile(output, frame.frame).string() : output;
        GLINT_TRY_DO(loop.advance(i, frame));
        GLINT_TRY(const auto image, loop.render(frame));
        GLINT_TRY(const auto accepted, accept());
        if (!accepted) {
            return okStatus();
        }
        // A sequence keeps the exposure of its first picture, because it would flicker otherwise.
        if (i == 0) {
            GLINT_TRY(report.exposure, loop.exposureOf(image));
            report.exposureAutomatic = setup.arguments.exposure == "auto";
            if (!report.exposureAutomatic) {
                compiler::parseReal(setup.arguments.exposure, -kMaxExposure, kMaxExposure, report.exposure);
            }
        }
        GLINT_TRY_DO(write(loop, setup, frame, image, report));
        if (movement.isSequence) {
            report.frames.push_back(std::move(frame));
        }
    }
    return okStatus();
}

}  // namespace glint::cli
