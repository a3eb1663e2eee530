#include "cli/console.h"

#include <set>
#include <sstream>

namespace glint::cli {

namespace {

struct DiagnosticList {
    std::uint8_t severity;
    std::string_view ids;  // with a blank before and after each
};

// An id is in several lists where its severity depends on the case. Each list is sorted, for people.
constexpr DiagnosticList kLists[] = {
    {kError,
     " accessor-component-type accessor-count accessor-range accessor-stride accessor-type"
     " animation-missing animation-unknown asset-version attribute-count attribute-type bench-advice"
     " bench-folder bindings bounces budget-instructions budget-ray-queries budget-texture-fetches"
     " buffer-data buffer-external buffer-size buffer-view-range calibration-format calibration-points"
     " calibration-strategies camera camera-matrix camera-range camera-type camera-unknown check-albedo"
     " check-density check-energy check-proof check-range check-reciprocity check-samples"
     " check-unreachable context-handles context-queue context-services data-uri declaration denoise-failed"
     " denoise-missing depfile-name device-features device-layers device-missing device-tracer"
     " draco-attribute draco-decode draco-size edit-format edit-unknown edit-value effect-missing"
     " effect-unknown emissive-lights engine-scene"
     " environment-missing environment-radiance environment-size environment-unread environment-unsampled"
     " exception exr-encode extension-unsupported file-open file-read file-size file-write first-shadows"
     " frame-not-recorded"
     " frame-options glb-chunk glb-length glb-version glsl gltf gpu-table gpu-unknown half-precision"
     " hit-lobe-unknown host-folder host-unknown image-data image-decode image-extension image-format"
     " image-mismatch image-size index-range internal json-depth json-missing json-range json-syntax"
     " json-type layer-effect layer-missing light-type lights lint-path lock-format lock-outdated malioc"
     " manifest-format material-list material-unknown materials-folder"
     " materials-glsl materialx max-error max-shaders memory-count memory-host memory-size memory-type "
     "meshopt-decode "
     "meshopt-layout meshopt-size "
     "module-features"
     " module-format module-missing module-stale module-unknown morph-limit ninja-name node-cycle"
     " node-parents node-transform order-check out-of-memory output output-busy output-folder"
     " output-not-a-folder output-not-a-package output-not-a-plan output-write package-altered"
     " package-bounces package-fallback package-file-name package-foreign package-frame package-mismatch"
     " package-missing package-module-altered package-module-missing package-passes package-read"
     " package-replaced package-strategy package-tracer package-truncated package-version passes"
     " pipeline-budget pipeline-budget-file pipeline-cache pipeline-failed pipeline-report"
     " pipeline-statistics png-encode position-fetch position-missing primitive-mode primitive-restart"
     " profile-format prove-unsupported query-live-objects query-proceed-conditional query-proceeds"
     " ray-steps render-size renderer-options scene-attribute scene-edit-case scene-edit-feature"
     " scene-edit-frame scene-edit-handle scene-edit-key scene-edit-room"
     " scene-edit-used scene-edit-value scene-empty scene-format"
     " scene-geometries scene-image scene-index scene-light scene-material scene-missing scene-motion"
     " scene-order scene-origin scene-package scene-samplers scene-still scene-textures scene-unknown"
     " settings-file sized-lights skin-attribute skin-joint-range skin-joints skin-matrices"
     " sky sky-light source-conditional source-include source-version sparse-count sparse-index"
     " spirv-format spirv-functions spirv-invalid spirv-join spirv-linkage spirv-optimize spirv-validate "
     "strategy"
     " stream-frame template texture-basisu texture-dimension texture-trusted threads timings-pending"
     " timings-unavailable"
     " tlas-limit tracer uri-unsafe validation validation-layer variant-unknown verify-missing"
     " vertex-limit view-layer view-reference view-source vulkan-call vulkan-function vulkan-loader"
     " werror window-drop window-missing window-open window-surface"
     " "},
    {kWarning,
     " accessor-bounds accessor-form accessor-layout alpha-mode animation-channel animation-keyframes"
     " animation-pointer asset-version attribute-name attribute-not-finite bench-point bench-reference"
     " buffer-external calibrate-picture calibrate-point calibration-device camera-range color-normalized"
     " draco-attribute draco-count effect-unused environment-aspect environment-negative"
     " extension-ignored extension-unlisted glb-chunk glb-length gpu-device image-type input-missing"
     " json-padding ktx2-metadata light-range lock-conflict malioc material-conflict material-range"
     " max-shaders memory-heap meshopt-layout morph-attribute morph-targets morph-weights node-instances "
     "node-matrix"
     " node-rotation non-finite normal-invalid nothing-drawn nothing-seen payload-bytes"
     " pipeline-budget-unused pose-degenerate position-not-finite primitive-empty primitive-restart"
     " primitive-skipped profile-empty profile-keys profile-settings query-flags query-micromap-states"
     " query-proceed-loop query-proceed-missing query-structure-index query-structure-load"
     " ray-pipeline-shaders sampler-value scene-node-child scene-node-repeated setting-idle"
     " skin-attribute skin-influences skin-joint-outside skin-matrices skin-weights sparse-index"
     " tangent-invalid tangent-without-normal texture-source texture-uv-set trace-from-hit"
     " triangle-incomplete validation variant-repeated"
     " "},
    {kNote,
     " alpha-blend alpha-stochastic alpha-tested animation-pointer cache-write calibration-points"
     " edit-fallback edit-unused effect-absent environment-resampled extension-no-picture gpu-choice "
     "lock-moved lock-stale merge-choice"
     " node-instances payload-bytes pipeline-cache pipeline-statistics profile-keys profile-stale"
     " query-flags scene-choice texture-basisu texture-compression texture-source texture-unknown"
     " window-shot"
     " "},
};

}  // namespace

std::vector<std::string> diagnosticIds(std::uint8_t severities) {
    std::set<std::string> ids;
    for (const DiagnosticList& list : kLists) {
        if ((list.severity & severities) != 0) {
            std::istringstream words{std::string(list.ids)};
            for (std::string id; words >> id;) {
                ids.insert(id);
            }
        }
    }
    return {ids.begin(), ids.end()};
}

std::uint8_t severitiesOf(std::string_view id) {
    std::uint8_t severities = 0;
    for (const DiagnosticList& list : kLists) {
        const bool isListed = id.find(' ') == std::string_view::npos &&
                              list.ids.find(" " + std::string(id) + " ") != std::string_view::npos;
        severities |= isListed ? list.severity : std::uint8_t{0};
    }
    return severities;
}

}  // namespace glint::cli
