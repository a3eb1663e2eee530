// The layers of OpenEXR files, as another reader finds them.
#include "image/image_file.h"
#include "support/must.h"

#include <ImfChannelList.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfInputFile.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <half.h>
#include <string>
#include <vector>

namespace glint {
namespace {

constexpr std::uint32_t kLayersWidth = 5;
constexpr std::uint32_t kLayersHeight = 3;

// Reads one channel of a file as it is stored.
template <typename Value>
std::vector<Value> channelOf(Imf::InputFile& file, const std::string& name, Imf::PixelType type) {
    std::vector<Value> values(kLayersWidth * kLayersHeight);
    const Imf::Channel* const channel = file.header().channels().findChannel(name);
    if (channel == nullptr || channel->type != type) {
        ADD_FAILURE() << name << " is not there, or has another type";
        return values;
    }
    Imf::FrameBuffer buffer;
    buffer.insert(name, Imf::Slice(type, reinterpret_cast<char*>(values.data()), sizeof(Value),
                                   sizeof(Value) * kLayersWidth));
    file.setFrameBuffer(buffer);
    file.readPixels(0, kLayersHeight - 1);
    return values;
}

TEST(ExrLayers, HaveTheirNamesTypesAndValues) {
    const std::filesystem::path path =
        std::filesystem::path(GLINT_BINARY_DIR) / "tests" / "tmp" / "layers.exr";
    std::filesystem::create_directories(path.parent_path());
    LinearImage picture{kLayersWidth, kLayersHeight, {}};
    image::ExrLayer depth{"depth", "Z", false, {kLayersWidth, kLayersHeight, 1, {}, {}}};
    image::ExrLayer motion{
        "reflection.virtual-motion", "XYZ", true, {kLayersWidth, kLayersHeight, 4, {}, {}}};
    image::ExrLayer material{"material", "I", false, {kLayersWidth, kLayersHeight, 1, {}, {}}};
    for (std::uint32_t i = 0; i < kLayersWidth * kLayersHeight; ++i) {
        const auto value = static_cast<float>(i);
        picture.pixels.push_back({value, 2.0F * value, 3.0F * value, 1.0F});
        depth.values.reals.push_back(value / 3.0F);
        for (const float component : {value, value - 0.5F, 100.0F, 77.0F}) {
            motion.values.reals.push_back(component);
        }
        material.values.integers.push_back(0xFFFFFFFFU - i);
    }
    const std::vector<image::ExrLayer> layers{depth, motion, material};
    ASSERT_TRUE(image::writeImage(path, picture, 0.0, layers));
    const LinearImage read = must(image::readImage(path));
    EXPECT_EQ(read.pixels, picture.pixels) << "a reader that knows no layers has the picture";

    Imf::InputFile file(path.string().c_str());
    EXPECT_EQ(channelOf<float>(file, "depth.Z", Imf::FLOAT), depth.values.reals);
    EXPECT_EQ(channelOf<std::uint32_t>(file, "material.I", Imf::UINT), material.values.integers);
    const auto y = channelOf<Imath::half>(file, "reflection.virtual-motion.Y", Imf::HALF);
    const auto z = channelOf<Imath::half>(file, "reflection.virtual-motion.Z", Imf::HALF);
    for (std::size_t i = 0; i < y.size(); ++i) {
        EXPECT_EQ(static_cast<float>(y[i]), static_cast<float>(i) - 0.5F);
        EXPECT_EQ(static_cast<float>(z[i]), 100.0F);
    }
    EXPECT_EQ(file.header().channels().findChannel("reflection.virtual-motion.A"), nullptr);
}

}  // namespace
}  // namespace glint
