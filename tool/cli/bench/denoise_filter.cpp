#include "cli/bench/bench.h"

// examples/denoise defines it, and links its filter.
#ifdef GLINT_DENOISE_FILTER
#include "denoiser.h"
#endif

namespace glint::cli {

#ifdef GLINT_DENOISE_FILTER

namespace {

class ExampleFilter : public measure::PictureFilter {
public:
    explicit ExampleFilter(std::unique_ptr<denoise::Denoiser> denoiser) : denoiser_(std::move(denoiser)) {}

    Result<LinearImage> filter() override {
        return denoiser_->filter();
    }
    double milliseconds() const override {
        return denoiser_->milliseconds();
    }
    void restart() override {
        denoiser_->restart();
    }

private:
    std::unique_ptr<denoise::Denoiser> denoiser_;
};

Result<std::unique_ptr<measure::PictureFilter>> makeExampleFilter(const Context& context,
                                                                  const Renderer& renderer,
                                                                  std::uint32_t width, std::uint32_t height,
                                                                  std::uint32_t samples) {
    denoise::FilterSettings settings;
    settings.samples = samples;
    GLINT_TRY(auto made, denoise::Denoiser::create(context, renderer, width, height, settings));
    return std::unique_ptr<measure::PictureFilter>(std::make_unique<ExampleFilter>(std::move(made)));
}

}  // namespace

const measure::FilterMaker* exampleFilter() {
    static const measure::FilterMaker kMaker{denoise::wantedLayers(), denoise::imageLayers(),
                                             makeExampleFilter};
    return &kMaker;
}

#else

const measure::FilterMaker* exampleFilter() {
    return nullptr;
}

#endif

}  // namespace glint::cli
