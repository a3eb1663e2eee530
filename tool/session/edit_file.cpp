// The file of edits: its members, and which of them an edit of each kind has.
#include "base/fields.h"
#include "base/lists.h"
#include "base/text.h"

#include <glint/session/edits.h>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string_view>

namespace glint::session {

using base::field;

namespace {

constexpr std::uint64_t kMaxEditBytes = 1ULL << 26;
// Single precision holds products of a few of such numbers.
constexpr double kMost = 1e9;

// A list of `count` numbers; an empty one is left out.
template <std::vector<double> Edit::*Member>
base::Field numbers(const char* name, const char* what, std::size_t count, double least = -kMost) {
    return field(
        name, what,
        [](const Edit& edit) { return (edit.*Member).empty() ? std::nullopt : std::optional(edit.*Member); },
        [](Edit& edit, std::optional<std::vector<double>> values) {
            edit.*Member = std::move(values).value_or(std::vector<double>());
        },
        {.least = least, .most = kMost, .optional = true, .mostElements = count});
}

base::FieldTraits textTraits() {
    return {.orNull = true, .optional = true};
}

// The members that an edit of a kind must have, and those that it may have.
struct KindMembers {
    EditKind kind;
    std::vector<std::string_view> must;
    std::vector<std::string_view> may;
};

const std::vector<KindMembers>& kindMembers() {
    static const std::vector<KindMembers> kRows{
        {EditKind::Hide, {"node"}, {}},
        {EditKind::Show, {"node"}, {}},
        {EditKind::Move, {"node"}, {"translation", "rotation", "scale", "matrix"}},
        {EditKind::Delete, {"node"}, {}},
        {EditKind::Duplicate, {"node"}, {"name", "parent", "translation", "rotation", "scale", "matrix"}},
        {EditKind::Parent, {"node"}, {"parent"}},
        {EditKind::Material, {"node", "material"}, {"primitive"}},
        {EditKind::Light, {"node"}, {"color", "intensity"}},
        {EditKind::Variant, {}, {"variant"}},
        {EditKind::Add, {"file"}, {"name", "parent", "translation", "rotation", "scale", "matrix"}},
    };
    return kRows;
}

void checkMembers(base::JsonReader& reader, const base::Json& json, const std::string& place,
                  const Edit& edit) {
    const KindMembers& row = *std::ranges::find(kindMembers(), edit.kind, &KindMembers::kind);
    for (const std::string_view name : row.must) {
        reader.member(json, place, std::string(name).c_str());
    }
    std::vector<std::string> known{"frame", "edit"};
    known.insert(known.end(), row.must.begin(), row.must.end());
    known.insert(known.end(), row.may.begin(), row.may.end());
    for (const auto& [name, value] : json.items()) {
        if (std::ranges::find(known, name) == known.end()) {
            reader.fail(fmt::format("{}/{}", place, name),
                        fmt::format("is no member of an edit \"{}\"{}", nameOf(edit.kind),
                                    base::suggestion(name, known)));
        }
    }
}

void checkValues(base::JsonReader& reader, const std::string& place, const Edit& edit) {
    const auto count = [&](const char* name, const std::vector<double>& values, std::size_t wanted) {
        if (!values.empty() && values.size() != wanted) {
            reader.fail(fmt::format("{}/{}", place, name),
                        fmt::format("has {} numbers, not {}", values.size(), wanted));
        }
    };
    count("translation", edit.translation, 3);
    count("rotation", edit.rotation, 4);
    count("scale", edit.scale, 3);
    count("matrix", edit.matrix, 16);
    count("color", edit.color, 3);
    const auto square = base::sumOf<double>(edit.rotation, [](double one) { return one * one; });
    // glTF wants unit quaternions; numbers that people type are rounded.
    if (!edit.rotation.empty() && !(std::abs(square - 1.0) < 0.01)) {
        reader.fail(place + "/rotation", "is no quaternion of length 1");
    }
    const bool hasParts = !edit.translation.empty() || !edit.rotation.empty() || !edit.scale.empty();
    if (!edit.matrix.empty() && hasParts) {
        reader.fail(place + "/matrix", "stands beside a translation, rotation or scale");
    }
    if (edit.matrix.size() == 16 && (edit.matrix[3] != 0.0 || edit.matrix[7] != 0.0 ||
                                     edit.matrix[11] != 0.0 || edit.matrix[15] != 1.0)) {
        reader.fail(place + "/matrix", "has another last row than 0 0 0 1");
    }
    if (edit.kind == EditKind::Move && edit.matrix.empty() && !hasParts) {
        reader.fail(place, "has neither a translation, rotation or scale nor a matrix");
    }
    if (edit.kind == EditKind::Light && edit.color.empty() && !edit.intensity) {
        reader.fail(place, "has neither a color nor an intensity");
    }
}

}  // namespace

static base::Fields fieldsOf(const Edit*) {
    using T = Edit;
    return {
        field<&T::frame>("frame", "Number of the frame before which the edit is made.", {.most = 1e6}),
        field(
            "edit", "What is done.", [](const T& it) { return std::string(nameOf(it.kind)); },
            [](T& it, const std::string& word) {
                it.kind = std::ranges::find(kEditKindNames, word, &Named<EditKind>::name)->value;
            },
            {.names = base::wordsFor<EditKind>()}),
        field<&T::node>("node", "Name of a node, or its number in the file as a text.", textTraits()),
        numbers<&T::translation>("translation", "Metres, relative to the parent.", 3),
        numbers<&T::rotation>("rotation", "Unit quaternion x, y, z, w.", 4),
        numbers<&T::scale>("scale", "Factors along the node's axes.", 3),
        numbers<&T::matrix>("matrix", "Column-major matrix, in place of the three.", 16),
        field<&T::name>("name", "Name of the node that is made.", textTraits()),
        field<&T::parent>("parent",
                          "Node above; without it a copy stays where its original is, and others get none.",
                          textTraits()),
        field<&T::material>("material", "Name of a material, or its number as a text.", textTraits()),
        field<&T::primitive>("primitive", "Number of a primitive; without it, all of the node's mesh.",
                             {.optional = true}),
        numbers<&T::color>("color", "Linear colour of the light.", 3, 0.0),
        field<&T::intensity>("intensity", "Lux of a directional light, candela of another one.",
                             {.least = 0.0, .most = kMost, .optional = true}),
        field<&T::variant>("variant", "Name of the variant; without it, the materials of no variant.",
                           textTraits()),
        field<&T::file>("file", "A .gltf or .glb file, relative to this one.", textTraits()),
    };
}

base::Fields fieldsOf(const EditList*) {
    return {field<&EditList::edits>("edits", "The edits, in any order of frames.")};
}

Result<std::vector<Edit>> readEdits(const std::filesystem::path& file) {
    base::JsonReader reader(file, "edit-format", "docs/live.md describes the file");
    GLINT_TRY(const auto json, reader.read(kMaxEditBytes));
    std::vector<Edit> edits = base::readAs<EditList>(reader, json).edits;
    for (std::size_t i = 0; i < edits.size() && reader.ok(); ++i) {
        Edit& edit = edits[i];
        const std::string place = fmt::format("/edits/{}", i);
        checkMembers(reader, json["edits"][i], place, edit);
        checkValues(reader, place, edit);
        edit.place = file.string() + "#" + place;
        if (!edit.file.empty()) {
            edit.file = (file.parent_path() / edit.file).string();
        }
    }
    if (!reader.ok()) {
        return reader.error();
    }
    std::ranges::stable_sort(edits, {}, &Edit::frame);
    return edits;
}

}  // namespace glint::session
