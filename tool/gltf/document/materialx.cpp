// MaterialX files with one surface of OpenPBR or Standard Surface. Such a file becomes a set of one material.
#include "base/text.h"
#include "gltf/document/material_list.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <map>
#include <optional>
#include <pugixml.hpp>
#include <string>
#include <string_view>
#include <vector>

namespace glint::gltf {

namespace {

constexpr std::string_view kOpenPbrModel = "openPbr";
constexpr std::string_view kOpenPbr = "open_pbr_surface";
constexpr std::string_view kStandard = "standard_surface";
constexpr const char* kMaterialXHint = "docs/material_lists.md says which MaterialX files are read";

using Numbers = std::vector<double>;

// An input of the surface: numbers, and the file of an image if it has one.
struct SurfaceInput {
    Numbers numbers;
    std::string file{};
    Numbers tiling{};
    Numbers offset{};
};
using SurfaceInputs = std::map<std::string, SurfaceInput, std::less<>>;

std::optional<Numbers> numbersOf(std::string_view text) {
    if (text == "true" || text == "false") {
        return Numbers{text == "true" ? 1.0 : 0.0};
    }
    Numbers numbers;
    while (!text.empty()) {
        const std::size_t begin = text.find_first_not_of(" \t\r\n");
        text.remove_prefix(std::min(begin, text.size()));
        double value = 0.0;
        const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
        if (error != std::errc() || !std::isfinite(value)) {
            return std::nullopt;
        }
        numbers.push_back(value);
        text.remove_prefix(static_cast<std::size_t>(end - text.data()));
        const std::size_t comma = text.find_first_not_of(" \t\r\n");
        text.remove_prefix(std::min(comma, text.size()));
        if (!text.empty() && text.front() != ',') {
            return std::nullopt;
        }
        text.remove_prefix(text.empty() ? 0 : 1);
    }
    return numbers.empty() ? std::nullopt : std::optional(numbers);
}

// The value of an attribute of a node or of the nearest one around it.
std::string_view inherited(pugi::xml_node node, const char* attribute) {
    for (; node; node = node.parent()) {
        if (const pugi::xml_attribute found = node.attribute(attribute)) {
            return found.value();
        }
    }
    return {};
}

// Standard Surface in terms of OpenPBR, as MaterialX publishes it in its library bxdf/translation,
// standard_surface_to_open_pbr. SurfaceInputs that it does not name change nothing.
class StandardSurface {
public:
    explicit StandardSurface(const SurfaceInputs& given) : given_(given) {}

    SurfaceInputs openPbr() const {
        SurfaceInputs made;
        const auto copy = [&](const char* name, const char* from, const Numbers& fallback) {
            const auto found = given_.find(from);
            SurfaceInput& input = made[name] = found == given_.end() ? SurfaceInput{fallback} : found->second;
            input.numbers.resize(fallback.size(), input.numbers.front());
        };
        const double coat = number("coat", 0.0);
        const double metalness = number("metalness", 0.0);
        const Numbers coatColor = color("coat_color");
        copy("base_weight", "base", {0.8});
        copy("base_color", "base_color", {1.0, 1.0, 1.0});
        for (std::size_t i = 0; i < 3; ++i) {
            made["base_color"].numbers[i] *= 1.0 + coat * (coatColor[i] - 1.0);
        }
        copy("base_diffuse_roughness", "diffuse_roughness", {0.0});
        copy("base_metalness", "metalness", {0.0});
        made["specular_weight"] = {{metalness > 0.0 ? 1.0 : number("specular", 1.0)}};
        Numbers specular = color("specular_color");
        made["specular_color"] = {specular[0] + specular[1] + specular[2] == 0.0 ? Numbers{1.0, 1.0, 1.0}
                                                                                 : std::move(specular)};
        copy("specular_roughness", "specular_roughness", {0.2});
        copy("specular_ior", "specular_IOR", {1.5});
        copy("specular_roughness_anisotropy", "specular_anisotropy", {0.0});
        copy("transmission_weight", "transmission", {0.0});
        copy("transmission_color", "transmission_color", {1.0, 1.0, 1.0});
        copy("transmission_depth", "transmission_depth", {0.0});
        copy("transmission_scatter", "transmission_scatter", {0.0, 0.0, 0.0});
        copy("transmission_scatter_anisotropy", "transmission_scatter_anisotropy", {0.0});
        copy("transmission_dispersion_scale", "transmission_dispersion", {0.0});
        copy("subsurface_weight", "subsurface", {0.0});
        copy("subsurface_color", "subsurface_color", {1.0, 1.0, 1.0});
        copy("subsurface_radius", "subsurface_scale", {1.0});
        copy("subsurface_radius_scale", "subsurface_radius", {1.0, 1.0, 1.0});
        copy("subsurface_scatter_anisotropy", "subsurface_anisotropy", {0.0});
        copy("fuzz_weight", "sheen", {0.0});
        copy("fuzz_color", "sheen_color", {1.0, 1.0, 1.0});
        made["fuzz_roughness"] = {{std::pow(std::max(number("sheen_roughness", 0.3), 0.0), 0.4)}};
        made["coat_weight"] = {{coat * metalness > 0.0 ? 0.0 : coat}};
        made["coat_color"] = {coatColor};
        copy("coat_roughness", "coat_roughness", {0.1});
        copy("coat_roughness_anisotropy", "coat_anisotropy", {0.0});
        copy("coat_ior", "coat_IOR", {1.5});
        copy("coat_darkening", "coat_affect_roughness", {0.0});
        const double film = number("thin_film_thickness", 0.0) * 0.001;  // nanometres
        made["thin_film_weight"] = {{film > 0.0 ? 1.0 : 0.0}};
        made["thin_film_thickness"] = {{film}};
        copy("thin_film_ior", "thin_film_IOR", {1.5});
        copy("emission_luminance", "emission", {0.0});
        copy("emission_color", "emission_color", {1.0, 1.0, 1.0});
        made["geometry_opacity"] = {{color("opacity")[0]}};
        copy("geometry_thin_walled", "thin_walled", {0.0});
        return made;
    }

private:
    double number(const char* name, double fallback) const {
        const auto found = given_.find(name);
        return found == given_.end() ? fallback : found->second.numbers.front();
    }
    Numbers color(const char* name) const {
        const auto found = given_.find(name);
        Numbers color = found == given_.end() ? Numbers{1.0} : found->second.numbers;
        color.resize(3, color.front());
        return color;
    }

    const SurfaceInputs& given_;
};

class SurfaceReader {
public:
    SurfaceReader(const std::filesystem::path& path, const materials::MaterialModel& model)
        : path_(path), model_(model) {}

    Result<MaterialSet> read(ByteView text) {
        const pugi::xml_parse_result parsed = xml_.load_buffer(text.data(), text.size());
        if (!parsed) {
            return fail("", fmt::format("is no XML: {} at byte {}", parsed.description(), parsed.offset));
        }
        root_ = xml_.child("materialx");
        std::vector<pugi::xml_node> surfaces;
        for (const pugi::xml_node node : root_.children()) {
            if (node.name() == kOpenPbr || node.name() == kStandard) {
                surfaces.push_back(node);
            }
        }
        if (surfaces.size() != 1) {
            return fail("", fmt::format("has {} surfaces; one {} or {} is read", surfaces.size(), kOpenPbr,
                                        kStandard));
        }
        surface_ = surfaces.front();
        SurfaceInputs inputs;
        for (const pugi::xml_node node : surface_.children("input")) {
            GLINT_TRY(inputs[node.attribute("name").value()], readInput(node));
        }
        if (surface_.name() == kStandard) {
            inputs = StandardSurface(inputs).openPbr();
        }
        const int feature = model_.findFeature(std::string(kOpenPbrModel));
        if (feature < 0) {
            return fail("", fmt::format("needs the model {}, which no pack declares", kOpenPbrModel),
                        "add --materials examples/materials/openpbr");
        }
        object_ = model_.features[static_cast<std::size_t>(feature)].object;
        return setOf(inputs);
    }

private:
    Diagnostic fail(const std::string& place, std::string message, const char* hint = kMaterialXHint) const {
        return makeError("materialx", place.empty() ? path_.string() : path_.string() + "#" + place,
                         std::move(message), hint);
    }
    std::string placeOf(pugi::xml_node input) const {
        return fmt::format("{}/{}", surface_.attribute("name").value(), input.attribute("name").value());
    }

    // The node that an input is connected to, or none.
    pugi::xml_node sourceOf(pugi::xml_node input) const {
        pugi::xml_node scope = root_;
        pugi::xml_node from = input;
        if (const pugi::xml_attribute graph = input.attribute("nodegraph")) {
            scope = root_.find_child_by_attribute("nodegraph", "name", graph.value());
            const pugi::xml_attribute output = input.attribute("output");
            from = output ? scope.find_child_by_attribute("output", "name", output.value())
                          : scope.child("output");
        }
        return scope.find_child_by_attribute("name", from.attribute("nodename").value());
    }

    // Colours in linear Rec. 709.
    Status toRec709(pugi::xml_node node, Numbers& color, const std::string& place) const {
        const std::string_view space = inherited(node, "colorspace");
        if (space == "acescg" || space == "lin_ap1") {
            // AP1 with the white point of ACES, adapted to D65 by Bradford's method.
            const Numbers from = color;
            color = {1.70505 * from[0] - 0.62179 * from[1] - 0.08326 * from[2],
                     -0.13026 * from[0] + 1.14080 * from[1] - 0.01055 * from[2],
                     -0.02400 * from[0] - 0.12897 * from[1] + 1.15297 * from[2]};
            std::ranges::transform(color, color.begin(), [](double c) { return std::max(c, 0.0); });
        } else if (space == "srgb_texture") {
            std::ranges::transform(color, color.begin(), [](double c) {
                return c <= 0.04045 ? c / 12.92 : std::pow((c + 0.055) / 1.055, 2.4);
            });
        } else if (!space.empty() && space != "lin_rec709" && space != "none") {
            return fail(place,
                        fmt::format("is in the colour space {}; lin_rec709, srgb_texture and acescg are read",
                                    space));
        }
        return okStatus();
    }

    Result<Numbers> readNumbers(pugi::xml_node node, std::string_view type, const std::string& place) const {
        const std::map<std::string_view, std::size_t> counts{{"float", 1},  {"integer", 1}, {"boolean", 1},
                                                             {"color3", 3}, {"vector2", 2}, {"vector3", 3}};
        const auto count = counts.find(type);
        std::optional<Numbers> numbers = numbersOf(node.attribute("value").value());
        if (count == counts.end() || !numbers || numbers->size() != count->second) {
            return fail(place, fmt::format("\"{}\" is no value of the type {}",
                                           node.attribute("value").value(), type));
        }
        if (type == "color3") {
            GLINT_TRY_DO(toRec709(node, *numbers, place));
        }
        return std::move(*numbers);
    }

    Result<SurfaceInput> readInput(pugi::xml_node input) const {
        const std::string place = placeOf(input);
        const std::string_view type = input.attribute("type").value();
        if (!input.attribute("nodename") && !input.attribute("nodegraph")) {
            GLINT_TRY(Numbers numbers, readNumbers(input, type, place));
            return SurfaceInput{std::move(numbers)};
        }
        const pugi::xml_node source = sourceOf(input);
        if (!source) {
            return fail(place, "is connected to a node that is not there");
        }
        const std::string_view kind = source.name();
        if (kind == "constant") {
            GLINT_TRY(Numbers numbers,
                      readNumbers(source.find_child_by_attribute("input", "name", "value"), type, place));
            return SurfaceInput{std::move(numbers)};
        }
        if (kind != "image" && kind != "tiledimage") {
            return fail(place,
                        fmt::format("comes from {}, a node of the kind {}; constant, image and tiledimage "
                                    "are read",
                                    source.attribute("name").value(), kind));
        }
        return readImage(source, type, place);
    }

    Result<SurfaceInput> readImage(pugi::xml_node image, std::string_view type,
                                   const std::string& place) const {
        const bool isColor = type == "color3";
        SurfaceInput read{isColor ? Numbers{1.0, 1.0, 1.0} : Numbers{1.0}};
        for (const pugi::xml_node part : image.children("input")) {
            const std::string_view name = part.attribute("name").value();
            if (part.attribute("nodename") || part.attribute("nodegraph") ||
                part.attribute("interfacename")) {
                return fail(place, fmt::format("comes from an image whose input {} is connected", name));
            }
            if (name == "file") {
                read.file = std::string(inherited(image, "fileprefix")) + part.attribute("value").value();
                const std::string_view space = inherited(part, "colorspace");
                const bool isSrgb = space == "srgb_texture";
                if (isColor != isSrgb) {
                    return fail(place, isColor
                                           ? "is an image that is not in srgb_texture, as Glint reads colours"
                                           : "is an image in srgb_texture, but is no colour");
                }
            } else if (name == "uvtiling" || name == "uvoffset") {
                GLINT_TRY((name == "uvtiling" ? read.tiling : read.offset),
                          readNumbers(part, "vector2", place));
            }
        }
        if (read.file.empty()) {
            return fail(place, fmt::format("comes from the image {}, which has no file",
                                           image.attribute("name").value()));
        }
        return read;
    }

    // The slot of the pack that an image of an input fills.
    Result<std::string> slotOf(const std::string& input, const SurfaceInputs& inputs) const {
        if (input == "base_color") {
            return std::string("colorTexture");
        }
        if (input == "emission_color") {
            return std::string("emissiveTexture");
        }
        const auto metalness = inputs.find("base_metalness");
        // The texture's blue scales the metalness, and a gray image has the roughness there.
        if (input == "specular_roughness" &&
            (metalness == inputs.end() ||
             (metalness->second.file.empty() && metalness->second.numbers.front() == 0.0))) {
            return std::string("roughnessMetalnessTexture");
        }
        return fail(fmt::format("{}/{}", surface_.attribute("name").value(), input),
                    "has an image; only base_color, emission_color and, where base_metalness is 0, "
                    "specular_roughness take one");
    }

    Result<MaterialSet> setOf(const SurfaceInputs& inputs) const {
        MaterialDescription made{.model = std::string(kOpenPbrModel)};
        for (const auto& given : inputs) {
            const std::string& name = given.first;
            const SurfaceInput& input = given.second;
            const auto parameter = std::ranges::find_if(
                model_.parameters,
                [&](const materials::Parameter& one) { return one.object == object_ && one.place == name; });
            if (parameter == model_.parameters.end()) {
                std::vector<std::string> names;
                for (const materials::Parameter& one : model_.parameters) {
                    if (one.object == object_) {
                        names.push_back(one.place);
                    }
                }
                return fail(fmt::format("{}/{}", surface_.attribute("name").value(), name),
                            fmt::format("no input of the model {} is called \"{}\"{}", kOpenPbrModel, name,
                                        base::suggestion(name, names)));
            }
            Numbers numbers = input.numbers;
            if (name == "base_color") {
                numbers.push_back(1.0);  // glTF's alpha
            }
            if (numbers.size() != static_cast<std::size_t>(parameter->numbers)) {
                return fail(fmt::format("{}/{}", surface_.attribute("name").value(), name),
                            fmt::format("has {} numbers; the input needs {}", input.numbers.size(),
                                        parameter->numbers - (name == "base_color" ? 1 : 0)));
            }
            made.values[parameter->declared] = numbers;
            if (!input.file.empty()) {
                GLINT_TRY(const std::string slot, slotOf(name, inputs));
                const Numbers tiling = input.tiling.empty() ? Numbers{1.0, 1.0} : input.tiling;
                const Numbers offset = input.offset.empty() ? Numbers{0.0, 0.0} : input.offset;
                // MaterialX has V upwards: v' = 1 - (1 - v) s + o in glTF's coordinates.
                made.textures[slot] = {.file = input.file,
                                       .offset = {-offset[0], 1.0 - tiling[1] + offset[1]},
                                       .scale = {tiling[0], tiling[1]}};
            }
        }
        const auto valueOf = [&](const char* name, double fallback) {
            const auto found = inputs.find(name);
            return found == inputs.end() ? fallback : found->second.numbers.front();
        };
        const pugi::xml_node material = root_.child("surfacematerial");
        made.name = (material ? material : surface_).attribute("name").value();
        made.alphaMode = valueOf("geometry_opacity", 1.0) < 1.0 ? materials::AlphaMode::Blend
                                                                : materials::AlphaMode::Opaque;
        made.doubleSided =
            valueOf("transmission_weight", 0.0) > 0.0 || valueOf("geometry_thin_walled", 0.0) > 0.0;
        return MaterialSet{path_, {std::move(made)}};
    }

    const std::filesystem::path& path_;
    const materials::MaterialModel& model_;
    int object_ = -1;
    pugi::xml_document xml_;
    pugi::xml_node root_;
    pugi::xml_node surface_;
};

}  // namespace

bool isMaterialX(ByteView text) {
    constexpr std::string_view kRoot = "<materialx";
    const auto first = std::ranges::find_if(
        text, [](std::uint8_t c) { return c != ' ' && c != '\t' && c != '\r' && c != '\n'; });
    return first != text.end() && *first == '<' &&
           std::search(text.begin(), text.end(), kRoot.begin(), kRoot.end()) != text.end();
}

Result<MaterialSet> readMaterialX(ByteView text, const std::filesystem::path& path,
                                  const materials::MaterialModel& model) {
    return SurfaceReader(path, model).read(text);
}

}  // namespace glint::gltf
