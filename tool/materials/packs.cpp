#include "base/files.h"
#include "materials/declaration_files.h"
#include "materials/declarations.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstdio>
#include <cstdlib>
#include <deque>
#include <map>
#include <mutex>
#include <regex>
#include <system_error>
#include <utility>
#include <vector>

namespace glint::materials {

namespace {

MaterialModel readBuiltinModel() {
    std::vector<DeclarationFile> files;
    for (const base::BuiltinFile& file : declarationFiles()) {
        files.push_back({file.name, file.text});
    }
    Result<MaterialModel> model = readDeclarations(files);
    if (!model) {
        // The build runs this before it finishes, so no installed library can come here.
        fmt::print(stderr, "{}\n", toString(model.error()));
        std::abort();
    }
    return std::move(*model);
}

}  // namespace

const MaterialModel& builtinMaterialModel() {
    static const MaterialModel kModel = readBuiltinModel();
    return kModel;
}

namespace fs = std::filesystem;

namespace {

constexpr std::uint64_t kMaxFileBytes = 16ULL << 20;

Diagnostic folderError(const std::string& folder, std::string message) {
    return makeError("materials-folder", folder, std::move(message),
                     "name a folder that holds <feature>/<feature>.json or <effect>/<effect>.json, as "
                     "docs/material_features.md and docs/effects.md describe");
}

// Returns whether a path has the extension, as std::filesystem does, which is much slower.
bool hasExtension(const fs::path& path, std::string_view extension) {
    const std::string text = path.generic_string();
    return text.size() > extension.size() && text.ends_with(extension) &&
           text[text.size() - extension.size() - 1] != '/';
}

bool isPackFile(const fs::path& path) {
    return hasExtension(path, ".json") || hasExtension(path, ".glsl") || hasExtension(path, ".comp") ||
           hasExtension(path, ".spv");
}

// Sorts paths without looking at their components, and leaves one of several that are equal.
void sortUnique(std::vector<fs::path>& paths) {
    const auto rank = [](char c) { return c == '/' ? 0 : static_cast<unsigned char>(c); };
    std::vector<std::pair<std::string, std::size_t>> order;
    for (const fs::path& path : paths) {
        order.emplace_back(path.generic_string(), order.size());
    }
    std::ranges::sort(order, [&](const auto& a, const auto& b) {
        return std::ranges::lexicographical_compare(a.first, b.first, {}, rank, rank);
    });
    std::vector<fs::path> sorted;
    for (const auto& [text, place] : order) {
        if (sorted.empty() || sorted.back() != paths[place]) {
            sorted.push_back(std::move(paths[place]));
        }
    }
    paths = std::move(sorted);
}

// Adds the files of one folder.
Status addFolder(const std::string& folder, std::vector<fs::path>& files) {
    std::error_code error;
    const std::size_t before = files.size();
    fs::recursive_directory_iterator place(folder, fs::directory_options::follow_directory_symlink, error);
    for (; !error && place != fs::recursive_directory_iterator(); place.increment(error)) {
        if (place.depth() > 0) {
            place.disable_recursion_pending();
        }
        if (isPackFile(place->path()) && place->is_regular_file(error)) {
            files.push_back(place->path());
        }
    }
    if (error) {
        return folderError(folder, fmt::format("can't be listed: {}", error.message()));
    }
    const auto begin = files.begin() + static_cast<std::ptrdiff_t>(before);
    if (std::none_of(begin, files.end(), [](const fs::path& path) { return hasExtension(path, ".json"); })) {
        return folderError(folder, "holds no declaration of a material feature or an effect");
    }
    return okStatus();
}

// Returns the files of a feature's GLSL, stage by stage; those of stages that it lacks are empty.
std::array<std::string_view, 8> filesOf(const FeatureCode& code) {
    return {code.surface,  code.bsdf,        code.layer,   code.model,
            code.emission, code.coordinates, code.opacity, code.diffuse};
}

using Sources = std::map<std::string_view, const ModelSource*>;  // by name

Sources sourcesOf(const MaterialModel& model) {
    Sources sources;
    for (const ModelSource& source : model.sources) {
        sources.emplace(source.name, &source);
    }
    return sources;
}

// Returns "file:line" of a place in a source.
std::string lineOf(const ModelSource& source, std::size_t place) {
    const auto end = source.text.begin() + static_cast<std::ptrdiff_t>(place);
    return fmt::format("{}:{}", source.name, 1 + std::count(source.text.begin(), end, '\n'));
}

Status checkCode(const MaterialModel& model, const Sources& sources) {
    const auto check = [&](const std::string& declared, const std::string& file) -> Status {
        return sources.contains(file)
                   ? okStatus()
                   : makeError("materials-glsl", file,
                               fmt::format("is named by the declaration of {}, but is not there", declared),
                               "write the file, or correct the member \"glsl\" of the declaration");
    };
    for (const EffectDeclaration& effect : model.effects) {
        for (const std::string* const file : effect.files()) {
            GLINT_TRY_DO(effect.isOfPack ? check(effect.name, *file) : okStatus());
        }
    }
    for (const FeatureCode& code : model.code) {
        // The build checks the files of Glint's own features.
        if (!code.isOfPack) {
            continue;
        }
        for (const std::string_view file : filesOf(code)) {
            GLINT_TRY_DO(file.empty() ? okStatus() : check(code.name, std::string(file)));
        }
    }
    return okStatus();
}

// Refuses a read of a texture in a file that never asks whether the key has it: the record of a material
// without the texture would give another one. `checked`, which may be null, is a model of the same
// declarations whose files are not looked at again.
Status checkReads(const MaterialModel& model, const MaterialModel* checked) {
    static const std::regex kRead(R"(sample(Slot|SlotAt|Point)\s*\(\s*\w+\s*,\s*k([A-Z]\w*))");
    const Sources known = checked != nullptr ? sourcesOf(*checked) : Sources();
    for (const ModelSource& source : model.sources) {
        if (const auto same = known.find(source.name);
            same != known.end() && same->second->text == source.text) {
            continue;
        }
        // A search for the word is much faster than one for the expression.
        const std::size_t first = std::min(source.text.find("sample"), source.text.size());
        const auto begin = source.text.begin() + static_cast<std::ptrdiff_t>(first);
        for (std::sregex_iterator read(begin, source.text.end(), kRead), end; read != end; ++read) {
            std::string name = (*read)[2];
            name[0] = static_cast<char>(name[0] - 'A' + 'a');
            const int texture = model.findTexture(name);
            if (texture < 0) {
                continue;
            }
            const int feature = model.textures[static_cast<std::size_t>(texture)].feature;
            const std::string asked = "HAS_" + model.features[static_cast<std::size_t>(feature)].macroEnd();
            if (source.text.find(asked) == std::string::npos) {
                return makeError("materials-glsl",
                                 lineOf(source, first + static_cast<std::size_t>(read->position())),
                                 fmt::format("reads k{}, but the file never asks whether the key has it",
                                             (*read)[2].str()),
                                 fmt::format("read it where GLINT_{}(features) is true", asked));
            }
        }
    }
    return okStatus();
}

// A parameter that belongs to no feature, and the texts that read it.
struct SharedValue {
    int parameter = 0;
    std::string byName;
    std::string byRole;  // empty: it has no role
};

// Refuses a read of a value of the replaced base that no parameter of the model fills, in the model's GLSL:
// records of the model have another value in its place.
Status checkValues(const MaterialModel& model, std::span<const SharedValue> values, int owner,
                   const ModelSource& source) {
    for (const SharedValue& value : values) {
        const std::size_t found =
            std::min(source.text.find(value.byName),
                     value.byRole.empty() ? std::string::npos : source.text.find(value.byRole));
        if (found != std::string::npos && !model.hasParameter(owner, value.parameter)) {
            const std::string& name = model.parameters[static_cast<std::size_t>(value.parameter)].name;
            return makeError("materials-glsl", lineOf(source, found),
                             fmt::format("reads {}, which the records of {} do not have", name,
                                         model.models[static_cast<std::size_t>(owner)].name),
                             fmt::format("declare a parameter with \"is\": \"{}\"", name));
        }
    }
    return okStatus();
}

Status checkValues(const MaterialModel& model, const Sources& sources) {
    std::vector<SharedValue> values;
    for (std::size_t i = 0; i < model.parameters.size(); ++i) {
        const Parameter& parameter = model.parameters[i];
        if (parameter.feature < 0 && parameter.inRecord) {
            values.push_back({static_cast<int>(i),
                              fmt::format("GLINT_MATERIAL_{}(", fieldMacro(parameter.name)),
                              parameter.role == package::Role::None ? "" : roleMacro(parameter.role) + "("});
        }
    }
    for (const FeatureCode& code : model.code) {
        const int owner =
            code.feature < 0 ? -1 : model.features[static_cast<std::size_t>(code.feature)].model;
        for (const std::string_view file : filesOf(code)) {
            if (const auto source = sources.find(file); owner >= 0 && source != sources.end()) {
                GLINT_TRY_DO(checkValues(model, values, owner, *source->second));
            }
        }
    }
    return okStatus();
}

Status checkSources(const MaterialModel& model, const MaterialModel* checked) {
    const Sources sources = sourcesOf(model);
    GLINT_TRY_DO(checkCode(model, sources));
    GLINT_TRY_DO(checkReads(model, checked));
    return checkValues(model, sources);
}

// Keeps models for as long as the program runs. The last one is the beginning of the next.
class KeptModels {
public:
    // Has the errors of loadMaterialModel() about contents.
    Result<const MaterialModel*> find(std::span<const DeclarationFile> files,
                                      std::vector<ModelSource> sources, std::vector<PackFile> read) {
        const std::lock_guard lock(mutex_);
        GLINT_TRY(auto parsed, parseDeclarations(files, parsed_));
        const bool isSame = !models_.empty() && parsed == parsed_;
        if (isSame && models_.back().sources == sources) {
            return &models_.back();
        }
        Result<MaterialModel> model =
            isSame ? Result<MaterialModel>(models_.back()) : readDeclarations(parsed);
        if (!model) {
            return model.error();
        }
        model->sources = std::move(sources);
        model->files = std::move(read);
        GLINT_TRY_DO(checkSources(*model, isSame ? &models_.back() : nullptr));
        parsed_ = std::move(parsed);
        return &models_.emplace_back(std::move(*model));
    }
    // Keeps a copy of `before` that has other GLSL. Error "materials-glsl".
    Result<const MaterialModel*> add(MaterialModel model, const MaterialModel& before) {
        const std::lock_guard lock(mutex_);
        GLINT_TRY_DO(checkSources(model, &before));
        // The last model has the declarations parsed_.
        return &before == &models_.back() ? &models_.emplace_back(std::move(model))
                                          : &models_.emplace_front(std::move(model));
    }

private:
    std::mutex mutex_;
    std::deque<MaterialModel> models_;
    ParsedDeclarations parsed_;  // the declarations of the last model
};

KeptModels& keptModels() {
    static KeptModels kept;
    return kept;
}

// Reads a file of a pack. Has the errors of readFile().
Result<std::string> readPackFile(const fs::path& file, PackFile& read) {
    GLINT_TRY(const auto bytes, base::readFile(file, kMaxFileBytes));
    std::string text(bytes.begin(), bytes.end());
    read = {file.string(), text.size(), base::hashBytes(text), hasExtension(file, ".json")};
    return text;
}

}  // namespace

Result<std::vector<fs::path>> packFiles(std::span<const std::string> folders) {
    std::vector<fs::path> files;
    for (const std::string& folder : folders) {
        GLINT_TRY_DO(addFolder(folder, files));
    }
    sortUnique(files);
    return files;
}

Result<const MaterialModel*> loadMaterialModel(std::span<const std::string> folders) {
    if (folders.empty()) {
        return &builtinMaterialModel();
    }
    GLINT_TRY(const auto files, packFiles(folders));
    std::deque<std::string> names;
    std::deque<std::string> texts;
    std::vector<DeclarationFile> declarations;
    std::vector<ModelSource> sources;
    std::vector<PackFile> read;
    for (const base::BuiltinFile& file : declarationFiles()) {
        declarations.push_back({file.name, file.text});
    }
    for (const fs::path& file : files) {
        GLINT_TRY(auto text, readPackFile(file, read.emplace_back()));
        if (!read.back().isDeclaration) {
            sources.push_back({file.generic_string(), std::move(text)});
        } else {
            declarations.push_back(
                {names.emplace_back(file.generic_string()), texts.emplace_back(std::move(text)), true});
        }
    }
    return keptModels().find(declarations, std::move(sources), std::move(read));
}

Result<const MaterialModel*> withPresentGlsl(const MaterialModel& model, std::span<const std::string> paths) {
    MaterialModel present = model;
    for (const std::string& path : paths) {
        const auto read = std::ranges::find(present.files, path, &PackFile::path);
        const auto source =
            std::ranges::find(present.sources, fs::path(path).generic_string(), &ModelSource::name);
        GLINT_TRY(source->text, readPackFile(path, *read));
    }
    return keptModels().add(std::move(present), model);
}

}  // namespace glint::materials
