#include "base/files.h"
#include "base/parallel.h"
#include "gltf/texels/levels.h"
#include "gltf/texels/texel_bounds.h"
#include "gltf/textures.h"
#include "gltf/trusted_textures.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstring>
#include <map>
#include <new>
#include <optional>
#include <string>
#include <type_traits>
#include <utility>

namespace glint::gltf {

namespace {

constexpr std::string_view kWholeKind = "texels";
constexpr std::string_view kSeenKind = "texels-seen";

template <typename Value>
void append(std::string& key, const Value& value) {
    static_assert(std::has_unique_object_representations_v<Value> || std::is_floating_point_v<Value>);
    key.append(reinterpret_cast<const char*>(&value), sizeof value);
}

template <typename Element>
std::uint64_t hashOf(const std::vector<Element>& elements, std::uint64_t seed) {
    const auto* const bytes = reinterpret_cast<const std::uint8_t*>(elements.data());
    return base::hashBytes(std::span(bytes, elements.size() * sizeof(Element)), seed);
}

// A range of codes, and texels that have its ends. It is kept byte by byte.
struct FoundRange {
    TexelRange range;
    std::array<TexelPlace, 4> leastAt{};
    std::array<TexelPlace, 4> greatestAt{};
};

struct WholeImage {
    FoundRange found;
    std::uint64_t texelHash = 0;
};
static_assert(std::is_trivially_copyable_v<WholeImage>);

// One way in which primitives look an image up.
struct Lookup {
    const Primitive* primitive = nullptr;
    int texCoord = 0;
    materials::TextureTransform transform;
    Sampler sampler;
    std::uint32_t channels = 0;  // that matter
    FoundRange found;
};

struct ImageWork {
    LevelRules rules;
    std::map<std::string, Lookup> lookups;  // by everything that decides about their results
    WholeImage whole;
    bool isKnown = false;
    std::optional<Diagnostic> error;
};

// Returns which channels of each texture matter: those on which reasons and behaviours depend. Textures that
// are 1 or constant are looked for in whole images if they are colours, because parts of these hardly are.
std::vector<std::uint32_t> channelsThatMatter(const materials::MaterialModel& model) {
    std::vector<std::uint32_t> channels(model.textures.size());
    const auto read = [&](const materials::Expression& expression) {
        for (const int symbol : expression.symbols()) {
            const int texel = symbol - model.symbolOfTexel(0);
            if (texel >= 0 && texel < static_cast<int>(channels.size())) {
                const std::uint32_t used = expression.channelsOf(symbol);
                channels[static_cast<std::size_t>(texel)] |= std::popcount(used) < 3 ? used : 0;
            }
            if (symbol >= static_cast<int>(model.parameters.size())) {
                continue;
            }
            const materials::Parameter& parameter = model.parameters[static_cast<std::size_t>(symbol)];
            const std::uint32_t used = parameter.scaledBy < 0 ? 0 : expression.channelsOf(symbol);
            for (std::size_t i = 0; i < 4 && used != 0; ++i) {
                const int channel = parameter.scaledByChannels[i];
                if ((used >> i & 1U) != 0 && channel >= 0) {
                    channels[static_cast<std::size_t>(parameter.scaledBy)] |=
                        1U << static_cast<unsigned>(channel);
                }
            }
        }
    };
    for (const materials::Feature& feature : model.features) {
        for (const materials::NeutralReason& reason : feature.neutral) {
            read(reason.when);
        }
    }
    for (const materials::BehaviourRule& rule : model.behaviours) {
        read(rule.when);
        if (rule.roughness) {
            read(*rule.roughness);
        }
    }
    return channels;
}

bool packsChangeCoordinates(const materials::MaterialModel& model) {
    return std::ranges::any_of(model.code, [](const materials::FeatureCode& code) {
        return code.isOfPack && !code.coordinates.empty();
    });
}

const materials::Material& plannedMaterial(const Scene& scene, int material) {
    const auto animated = std::ranges::find(scene.animatedMaterials, material, &AnimatedMaterial::material);
    return animated != scene.animatedMaterials.end() ? animated->planned
                                                     : scene.materials[static_cast<std::size_t>(material)];
}

const std::vector<Float2>& texCoordsOf(const Primitive& primitive, int set) {
    return set == 0 ? primitive.texCoords0 : primitive.texCoords1;
}

// Names the lookup by the content of what decides about it, except for the image.
std::string keyOf(const Lookup& lookup, std::uint64_t coordinates) {
    std::string key;
    append(key, coordinates);
    for (const float value :
         {lookup.transform.offset[0], lookup.transform.offset[1], lookup.transform.rotation,
          lookup.transform.scale[0], lookup.transform.scale[1]}) {
        append(key, value);
    }
    const Sampler& sampler = lookup.sampler;
    for (const int value : {static_cast<int>(sampler.wrapU), static_cast<int>(sampler.wrapV),
                            static_cast<int>(sampler.magnification), static_cast<int>(sampler.minification),
                            static_cast<int>(sampler.mip), static_cast<int>(sampler.mipmapped)}) {
        append(key, value);
    }
    append(key, lookup.channels);
    return key;
}

class ContentReader {
public:
    ContentReader(const ImportOptions& options, Scene& scene)
        : options_(options),
          scene_(scene),
          model_(*options.materialModel),
          matter_(channelsThatMatter(model_)),
          works_(scene.images.size()) {}

    Status read() {
        std::vector<ImageUse> uses = imageUses(scene_);
        for (std::size_t i = 0; i < works_.size(); ++i) {
            works_[i].rules = levelRulesOf(scene_.images[i], uses[i]);
            works_[i].isKnown = hasKnownTexels(scene_.images[i]) &&
                                !(scene_.images[i].file.empty() && scene_.images[i].pixels.empty());
        }
        if (!packsChangeCoordinates(model_)) {
            forEachSeen(
                [&](Primitive& /*primitive*/, int /*slot*/, int image, Lookup lookup, std::string key) {
                    works_[static_cast<std::size_t>(image)].lookups.try_emplace(std::move(key), lookup);
                });
        }
        base::runParallel(works_.size(), options_.jobs, [&](std::size_t i) {
            // One image fails alone.
            try {
                readImage(scene_.images[i], works_[i]);
            } catch (const std::bad_alloc&) {
                works_[i].error = makeError(
                    "image-decode", fmt::format("{}#{}", scene_.path, scene_.images[i].pointer),
                    "does not fit into memory", "scale the image down, or use a machine with more memory");
            }
            return true;
        });
        for (ImageWork& work : works_) {
            if (work.error && (options_.decodeImages || options_.keepImageFiles)) {
                return *work.error;
            }
            if (work.error) {
                work.isKnown = false;
                scene_.warnings.push_back(unknownTexels(*work.error));
            }
        }
        tellMaterials();
        findSameImages(std::move(uses));
        return okStatus();
    }

private:
    // Calls visit(primitive, slot, image, lookup, key) for each texture that a primitive shows a known part
    // of.
    template <typename Visit>
    void forEachSeen(const Visit& visit) {
        for (Mesh& mesh : scene_.meshes) {
            for (Primitive& primitive : mesh.primitives) {
                std::array<std::optional<std::uint64_t>, 2> hashes;
                const materials::Material& material = plannedMaterial(scene_, primitive.material);
                for (const auto& [slot, info] : material.textures) {
                    const std::uint32_t channels =
                        info.texture < 0 ? 0
                                         : matter_[slot] & material.readsOf(static_cast<int>(slot)).channels;
                    const bool hasOwnCoordinates =
                        model_.features[static_cast<std::size_t>(model_.textures[slot].feature)]
                            .hasOwnCoordinates;
                    if (info.texture < 0 || info.moves || hasOwnCoordinates || info.texCoord > 1 ||
                        channels == 0 || texCoordsOf(primitive, info.texCoord).empty()) {
                        continue;
                    }
                    std::optional<std::uint64_t>& hash = hashes[static_cast<std::size_t>(info.texCoord)];
                    if (!hash) {
                        hash = hashOf(texCoordsOf(primitive, info.texCoord), hashOf(primitive.indices, 0));
                    }
                    const Texture& texture = scene_.textures[static_cast<std::size_t>(info.texture)];
                    Lookup lookup{&primitive,     info.texCoord,
                                  info.transform, scene_.samplers[static_cast<std::size_t>(texture.sampler)],
                                  channels,       {}};
                    std::string key = keyOf(lookup, *hash);
                    visit(primitive, static_cast<int>(slot), texture.image, lookup, std::move(key));
                }
            }
        }
    }

    void readImage(Image& image, ImageWork& work) {
        std::string key = options_.memoScope;
        const std::vector<std::uint8_t>& bytes = image.file.empty() ? image.pixels : image.file;
        append(key, hashOf(bytes, 0));
        append(key, hashOf(bytes, 1));
        append(key, bytes.size());
        append(key, image.width);
        append(key, image.file.empty());
        std::optional<Texels> texels;
        if (!work.isKnown) {
            // Nothing is known of the texels, but equal files are equal.
            work.whole.texelHash = bytes.empty() ? 0 : hashOf(bytes, 0);
        } else if (!recall(kWholeKind, key, std::span(&work.whole, 1))) {
            if (!unpack(image, work, texels)) {
                return;
            }
            work.whole = wholeOf(*texels);
            keep(kWholeKind, key, std::span<const WholeImage>(&work.whole, 1));
        }
        if (work.isKnown) {
            readLookups(image, key, work, texels);
        }
        if (!options_.keepImageFiles) {
            image.file = {};
        }
    }

    void readLookups(const Image& image, std::string key, ImageWork& work, std::optional<Texels>& texels) {
        std::vector<Lookup*> open;
        for (const LevelFilter filter : work.rules.filters) {
            append(key, static_cast<int>(filter));
        }
        append(key, static_cast<int>(work.rules.mayBlit) + 2 * static_cast<int>(work.rules.mayStop) +
                        4 * static_cast<int>(work.rules.isUnknown));
        for (auto& [name, lookup] : work.lookups) {
            lookup.found = work.whole.found;
            const TexelRange& range = work.whole.found.range;
            for (std::size_t i = 0; i < 4; ++i) {
                lookup.channels &= range.least[i] == range.greatest[i] ? ~(1U << i) : ~0U;
            }
            if (lookup.channels != 0) {
                open.push_back(&lookup);
                key += name;
            }
        }
        std::vector<FoundRange> found(open.size());
        if (open.empty()) {
            return;
        }
        if (!recall(kSeenKind, key, std::span(found))) {
            if (!texels && !unpack(image, work, texels)) {
                return;
            }
            const TexelBounds bounds(std::move(*texels), work.rules);
            for (std::size_t i = 0; i < open.size(); ++i) {
                found[i] = rangeOf(bounds, *open[i]);
            }
            keep(kSeenKind, key, std::span(std::as_const(found)));
        }
        for (std::size_t i = 0; i < open.size(); ++i) {
            open[i]->found = found[i];
        }
    }

    static FoundRange rangeOf(const TexelBounds& bounds, const Lookup& lookup) {
        const std::vector<Float2>& coordinates = texCoordsOf(*lookup.primitive, lookup.texCoord);
        const std::vector<std::uint32_t>& indices = lookup.primitive->indices;
        const LookupKind kind{lookup.sampler, false, true};
        const auto boxAt = [&](std::size_t first) {
            const Float2 corners[] = {coordinates[indices[first]], coordinates[indices[first + 1]],
                                      coordinates[indices[first + 2]]};
            return boxOf(corners, lookup.transform);
        };
        FoundRange found;
        for (std::size_t i = 0; i + 2 < indices.size() && !found.range.encloses(bounds.whole()); i += 3) {
            bounds.joinOver(boxAt(i), kind, found.range);
        }
        for (std::size_t channel = 0; channel < 4; ++channel) {
            if ((lookup.channels >> channel & 1U) == 0) {
                continue;
            }
            const auto find = [&](bool greatest) {
                TexelPlace place;
                for (std::size_t i = 0; i + 2 < indices.size() && place.level < 0; i += 3) {
                    place = bounds.find(boxAt(i), kind, found.range, channel, greatest);
                }
                return place;
            };
            found.leastAt[channel] = find(false);
            found.greatestAt[channel] = find(true);
        }
        return found;
    }

    template <typename Code>
    static WholeImage wholeOfCodes(const Texels& texels) {
        WholeImage whole;
        whole.texelHash = hashOf(texels.bytes, 0);
        FoundRange& found = whole.found;
        std::size_t offset = 0;
        for (int level = 0; level < texels.levels; ++level) {
            const int width = sizeOfLevel(texels.width, level);
            const int height = sizeOfLevel(texels.height, level);
            for (int y = 0; y < height; ++y) {
                for (int x = 0; x < width; ++x) {
                    std::array<Code, 4> texel{};
                    std::memcpy(texel.data(), &texels.bytes[offset], sizeof texel);
                    offset += sizeof texel;
                    for (std::size_t i = 0; i < 4; ++i) {
                        if (texel[i] < found.range.least[i] || found.leastAt[i].level < 0) {
                            found.range.least[i] = texel[i];
                            found.leastAt[i] = {level, x, y};
                        }
                        if (texel[i] > found.range.greatest[i] || found.greatestAt[i].level < 0) {
                            found.range.greatest[i] = texel[i];
                            found.greatestAt[i] = {level, x, y};
                        }
                    }
                }
            }
        }
        return whole;
    }
    static WholeImage wholeOf(const Texels& texels) {
        return texels.format == PixelFormat::Rgba16 ? wholeOfCodes<std::uint16_t>(texels)
                                                    : wholeOfCodes<std::uint8_t>(texels);
    }

    bool unpack(const Image& image, ImageWork& work, std::optional<Texels>& texels) const {
        Result<Texels> read = texelsOf(scene_, image);
        if (!read) {
            work.error = read.error();
            return false;
        }
        texels = std::move(*read);
        return true;
    }

    template <typename Value>
    bool recall(std::string_view kind, const std::string& key, std::span<Value> values) const {
        const std::optional<std::string> found =
            options_.memo == nullptr ? std::nullopt : options_.memo->find(kind, key);
        if (!found || found->size() != values.size_bytes()) {
            return false;
        }
        std::memcpy(values.data(), found->data(), found->size());
        return true;
    }
    template <typename Value>
    void keep(std::string_view kind, const std::string& key, std::span<const Value> values) const {
        static_assert(std::is_trivially_copyable_v<Value>);
        if (options_.memo != nullptr) {
            options_.memo->put(kind, key,
                               {reinterpret_cast<const char*>(values.data()), values.size_bytes()});
        }
    }

    materials::TextureContent contentOf(const FoundRange& found, int image, bool isColor) const {
        const Image& source = scene_.images[static_cast<std::size_t>(image)];
        const ImageWork& work = works_[static_cast<std::size_t>(image)];
        materials::TextureContent content;
        if (!work.isKnown) {
            return content;
        }
        content.image = source.pointer;
        const auto stored = valuesOf(found.range, source.format, work.rules.tolerance);
        content.of = contentAsRead(stored, isColor);
        content.leastAt = found.leastAt;
        content.greatestAt = found.greatestAt;
        for (std::size_t i = 0; i < 4; ++i) {
            if (stored[i].isExact()) {
                content.constant[i] = numberAsRead(stored[i].low, isColor && i < 3);
            }
        }
        return content;
    }

    void tell(materials::Material& material) const {
        for (auto& [slot, info] : material.textures) {
            if (info.texture >= 0) {
                const int image = scene_.textures[static_cast<std::size_t>(info.texture)].image;
                info.content = contentOf(works_[static_cast<std::size_t>(image)].whole.found, image,
                                         material.isColor(static_cast<int>(slot)));
            }
        }
    }

    void tellMaterials() {
        std::ranges::for_each(scene_.materials, [&](materials::Material& material) { tell(material); });
        for (AnimatedMaterial& animated : scene_.animatedMaterials) {
            tell(animated.rest);
            tell(animated.planned);
        }
        if (packsChangeCoordinates(model_)) {
            return;
        }
        forEachSeen(
            [&](Primitive& primitive, int slot, int image, const Lookup& /*lookup*/, const std::string& key) {
                const ImageWork& work = works_[static_cast<std::size_t>(image)];
                const Lookup& lookup = work.lookups.at(key);
                if (!work.isKnown || lookup.channels == 0) {
                    return;
                }
                const materials::Material& material =
                    scene_.materials[static_cast<std::size_t>(primitive.material)];
                primitive.seen.push_back({slot, contentOf(lookup.found, image, material.isColor(slot))});
            });
    }

    // Whether both uses make the same levels of the channels that both read.
    static bool haveSameLevels(const ImageUse& a, const ImageUse& b) {
        const std::uint32_t both = a.channels & b.channels;
        return a.isColor == b.isColor && a.isData == b.isData && a.isNormals == b.isNormals &&
               (a.roughness & both) == (b.roughness & both) && (a.glossiness & both) == (b.glossiness & both);
    }

    void findSameImages(std::vector<ImageUse> uses) {
        for (std::size_t i = 0; i < works_.size(); ++i) {
            Image& image = scene_.images[i];
            for (std::size_t j = 0; j < i && image.sameAs < 0; ++j) {
                const Image& other = scene_.images[j];
                if (works_[i].error || works_[i].whole.texelHash == 0) {
                    break;
                }
                // Levels are made by an image's use.
                if (other.sameAs < 0 && works_[i].whole.texelHash == works_[j].whole.texelHash &&
                    static_cast<const ImageShape&>(image) == other && image.format == other.format &&
                    image.storage == other.storage && image.transfer == other.transfer &&
                    haveSameLevels(uses[i], uses[j])) {
                    image.sameAs = static_cast<int>(j);
                    uses[j].channels |= uses[i].channels;
                    uses[j].roughness |= uses[i].roughness;
                    uses[j].glossiness |= uses[i].glossiness;
                }
            }
        }
    }

    const ImportOptions& options_;
    Scene& scene_;
    const materials::MaterialModel& model_;
    std::vector<std::uint32_t> matter_;  // by slot
    std::vector<ImageWork> works_;
};

}  // namespace

Status readTextureContent(const ImportOptions& options, Scene& scene) {
    return ContentReader(options, scene).read();
}

}  // namespace glint::gltf
