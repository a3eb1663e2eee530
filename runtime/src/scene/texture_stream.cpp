#include "scene/texture_stream.h"

#include "context/parallel.h"
#include "scene/scene_store.h"

#include <algorithm>
#include <string>
#include <utility>

namespace glint {
namespace {

std::uint32_t largestSide(const ImageView& image, std::uint32_t level) {
    return sizeAtLevel(std::max(image.width, image.height), level);
}

// The part of a level that a recording copies.
struct Step {
    std::uint32_t texture = 0;
    std::uint32_t level = 0;  // where the texture is after it
    std::uint32_t row = 0;
};

// Everything that a recording changes.
struct Advance {
    std::map<std::uint32_t, StreamedTexture*> waiting;
    std::map<std::uint32_t, Step> reached;
    std::uint32_t completed = 0;
};

// Returns the texture whose next level is smallest, or the end.
auto nextOf(const Advance& advance) {
    return std::ranges::min_element(advance.waiting, {}, [&](const auto& entry) {
        return largestSide(entry.second->image.view, advance.reached.at(entry.first).level - 1);
    });
}

// Queues copies of about `mostBytes`.
Status queueCopies(TextureStream::State& state, std::uint64_t mostBytes, Advance& advance) {
    std::uint64_t room = std::max<std::uint64_t>(mostBytes, 1);
    while (!advance.waiting.empty() && room > 0) {
        const auto next = nextOf(advance);
        StreamedTexture& texture = *next->second;
        Step& step = advance.reached.at(next->first);
        const ImageView& image = texture.image.view;
        const std::uint32_t level = step.level - 1;
        const TexelBlock block = blockOf(image.format);
        const std::uint64_t rowBytes =
            std::uint64_t{blocksAcross(sizeAtLevel(image.width, level), block.width)} * block.bytes;
        GLINT_TRY(const auto rows, state.uploader->copyMipRows({&state.scene.textures[next->first], level,
                                                                step.row, texelsOfLevel(image, level), block},
                                                               room));
        room -= std::min(room, rows * rowBytes);
        step.row += rows;
        if (step.row == blocksAcross(sizeAtLevel(image.height, level), block.height)) {
            step.level = level;
            step.row = 0;
            ++advance.completed;
            if (level <= texture.finest) {
                advance.waiting.erase(next);
            }
        }
    }
    return okStatus();
}

// Views of the images that have got a level, from that level on.
Result<std::map<std::uint32_t, UniqueImageView>> newViews(const TextureStream::State& state,
                                                          const Advance& advance) {
    std::map<std::uint32_t, UniqueImageView> views;
    for (const auto& [number, step] : advance.reached) {
        if (step.level == state.textures.at(number).level) {
            continue;
        }
        const DeviceImage& image = state.scene.textures[number];
        ImageInfo info;
        info.format = image.format;
        info.components = image.components;
        GLINT_TRY(auto view, createImageView(state.scene.context, image.handle.get(), info, step.level));
        views.emplace(number, std::move(view));
    }
    return views;
}

void exchangeViews(TextureStream::State& state, std::map<std::uint32_t, UniqueImageView>& views) {
    for (auto& [number, view] : views) {
        std::swap(state.scene.textures[number].view, view);
    }
}

// Lets frames that are recorded from now on read the new levels. Those in flight keep their set and views.
Status adoptViews(TextureStream::State& state, std::map<std::uint32_t, UniqueImageView> views) {
    if (views.empty()) {
        return okStatus();
    }
    exchangeViews(state, views);
    // The set of a scene that is edited stays in use until the editor's next recording.
    Retired* retired = &state.retired;
    if (state.scene.editor != nullptr) {
        state.scene.store->setDirty = true;
        retired = &state.scene.store->retired;
    } else {
        Result<DescriptorSet> set = makeSceneSet(state.scene, state.scene.tlas.handle.get(), VK_NULL_HANDLE);
        if (!set) {
            exchangeViews(state, views);
            return set.error();
        }
        state.retired.add(std::move(state.scene.descriptorPool));
        state.scene.descriptorPool = std::move(set->pool);
        state.scene.set = set->set;
    }
    for (auto& [number, view] : views) {
        retired->add(std::move(view));
    }
    return okStatus();
}

}  // namespace

TextureStream::TextureStream(std::unique_ptr<State> state) : state_(std::move(state)) {}
TextureStream::~TextureStream() = default;

TextureStream::State& TextureStream::state() {
    return *state_;
}

Result<std::uint32_t> TextureStream::record(VkCommandBuffer commands, std::uint64_t frame,
                                            std::uint64_t mostBytes) try {
    if (frame < state_->lastFrame) {
        return makeError("stream-frame", "",
                         phrase("the frame ", frame, " comes after the frame ", state_->lastFrame),
                         "give each frame a number that is not below that of the frame before");
    }
    Advance advance;
    for (auto& [number, texture] : state_->textures) {
        if (texture.waits()) {
            advance.waiting.emplace(number, &texture);
            advance.reached.emplace(number, Step{number, texture.level, texture.row});
        }
    }
    Status status = queueCopies(*state_, mostBytes, advance);
    if (status) {
        Result<std::map<std::uint32_t, UniqueImageView>> views = newViews(*state_, advance);
        status = views ? adoptViews(*state_, std::move(*views)) : Status(views.error());
    }
    if (!status) {
        state_->uploader->forgetAfter(0);
        return status.error();
    }
    for (Buffer& staging : state_->uploader->record(commands)) {
        state_->retired.add(std::move(staging));
    }
    for (const auto& [number, step] : advance.reached) {
        StreamedTexture& texture = state_->textures.at(number);
        texture.level = step.level;
        texture.row = step.row;
        if (texture.level == 0) {
            state_->textures.erase(number);
        }
    }
    state_->retired.close(frame);
    state_->lastFrame = frame;
    return advance.completed;
}
GLINT_CATCH

void TextureStream::complete(std::uint64_t frame) {
    state_->retired.complete(frame);
}

void TextureStream::setFinest(std::uint32_t texture, std::uint32_t level) {
    if (const auto found = state_->textures.find(texture); found != state_->textures.end()) {
        found->second.finest = level;
    }
}

std::uint32_t TextureStream::finest(std::uint32_t texture) const {
    const auto found = state_->textures.find(texture);
    return found == state_->textures.end() ? 0 : found->second.level;
}

TextureStream::Progress TextureStream::progress() const {
    Progress progress;
    for (const auto& [number, texture] : state_->textures) {
        if (texture.waits()) {
            const ImageView& image = texture.image.view;
            ++progress.textures;
            progress.bytes += image.byteCount(texture.level) - image.byteCount(texture.finest);
        }
    }
    return progress;
}

std::uint64_t TextureStream::retiredBytes() const {
    return state_->retired.bytes();
}

Result<DeviceImage> uploadStreamed(TextureStream::State& stream, Uploader& uploader, std::uint32_t texture,
                                   const ImageView& image, bool srgb) {
    GpuScene::State& scene = stream.scene;
    StreamedTexture streamed{storedImage(scene.context, image, srgb)};
    const ImageView& stored = streamed.image.view;
    const ImageInfo info = textureInfo(stored, streamed.image.srgb);
    while (streamed.level + 1 < info.mips && largestSide(stored, streamed.level) > stream.firstSize) {
        ++streamed.level;
    }
    if (streamed.level == 0 || stored.levels < info.mips || stored.dimension != ImageView::Dimension::Flat) {
        Result<DeviceImage> whole = uploadTexture(scene.context, scene.pool, uploader, image, srgb);
        if (whole) {
            stream.textures.erase(texture);
        }
        return whole;
    }
    Result<DeviceImage> made = createImage(scene.context, scene.pool, info);
    if (!made) {
        return made.error();
    }
    for (std::uint32_t level = streamed.level; level < info.mips; ++level) {
        const std::span<const std::uint8_t> texels = texelsOfLevel(stored, level);
        GLINT_TRY([[maybe_unused]] const auto rows,
                  uploader.copyMipRows({&*made, level, 0, texels, blockOf(stored.format)}, texels.size()));
    }
    GLINT_TRY(made->view, createImageView(scene.context, made->handle.get(), info, streamed.level));
    stream.textures.insert_or_assign(texture, std::move(streamed));
    return made;
}

Result<DeviceImage> uploadSceneTexture(GpuScene::State& scene, Uploader& uploader, std::uint32_t texture,
                                       const ImageView& image, bool srgb) {
    return scene.stream != nullptr ? uploadStreamed(scene.stream->state(), uploader, texture, image, srgb)
                                   : uploadTexture(scene.context, scene.pool, uploader, image, srgb);
}

void forgetTexture(GpuScene::State& scene, std::uint32_t texture) {
    if (scene.stream != nullptr) {
        scene.stream->state().textures.erase(texture);
    }
}

}  // namespace glint
