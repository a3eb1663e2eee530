#include "emit/warm_modules.h"

#include "base/files.h"
#include "base/parallel.h"
#include "cache/action.h"
#include "cache/store.h"
#include "emit/glsl/passes.h"

#include <algorithm>
#include <functional>
#include <optional>
#include <set>
#include <unordered_map>
#include <utility>

namespace glint::compiler {

ModuleGlsl::ModuleGlsl(GlslUnit unit)
    : hash_(hashOfText(essentialText(unit.text()))), unit_(std::move(unit)) {}

Result<const GlslUnit*> ModuleGlsl::unit() const {
    const std::lock_guard lock(making_);
    if (!unit_) {
        GLINT_TRY(unit_, make_());
    }
    return &*unit_;
}

std::uint64_t IncludedFiles::stateOf(std::span<const std::uint64_t> sources) const {
    std::vector<std::uint64_t> marks;
    marks.reserve(sources.size());
    for (const std::uint64_t source : sources) {
        const std::optional<std::uint64_t> own = own_->markOf(source);
        marks.push_back((own ? own : others_->markOf(source)).value_or(0));
    }
    return base::hashBytes(
        {reinterpret_cast<const std::uint8_t*>(marks.data()), marks.size() * sizeof(std::uint64_t)});
}

namespace {

// The sources of a text: the files that it includes, and of files with items those that it uses.
class UsedSources {
public:
    explicit UsedSources(const IncludedFiles& files) : files_(files) {}

    void addFile(std::string_view name) {
        const std::string& file = *names_.emplace(name).first;
        sources_.push_back(sourceNumber(file));
        if (const SourceSet::Items* const items = files_.itemsOf(file)) {
            itemFiles_.insert(file);
            for (const auto& [item, words] : *items) {
                items_.emplace(item, Item{file, &words});
            }
        }
    }
    // Adds the items that are named in `text`, or only in its lines from files without items.
    void addItemsOf(const GlslUnit& text, bool ofAllLines) {
        addItem("");
        for (std::size_t i = 0; i < text.size(); ++i) {
            if (ofAllLines || !itemFiles_.contains(text.file(i))) {
                addItemsOf(text.line(i));
            }
        }
    }
    std::vector<std::uint64_t> take() && {
        std::ranges::sort(sources_);
        sources_.erase(std::unique(sources_.begin(), sources_.end()), sources_.end());
        return std::move(sources_);
    }

private:
    struct Item {
        std::string_view file;
        const std::vector<std::string_view>* words = nullptr;  // null once it was added
    };

    // Takes words of comments for names, too.
    void addItemsOf(std::string_view line) {
        for (std::size_t i = 0; i < line.size();) {
            std::size_t end = i;
            while (end < line.size() && continuesWord(line[end])) {
                ++end;
            }
            if (end > i) {
                addItem(line.substr(i, end - i));
            }
            i = end + 1;
        }
    }
    void addItem(std::string_view name) {
        const auto [begin, end] = items_.equal_range(name);
        for (auto item = begin; item != end; ++item) {
            if (const auto* const words = std::exchange(item->second.words, nullptr)) {
                sources_.push_back(sourceNumber(item->second.file, name));
                std::ranges::for_each(*words, [this](std::string_view word) { addItem(word); });
            }
        }
    }

    const IncludedFiles& files_;
    std::set<std::string, std::less<>> names_;
    std::set<std::string_view> itemFiles_;
    std::unordered_multimap<std::string_view, Item> items_;
    std::vector<std::uint64_t> sources_;
};

}  // namespace

Result<GlslUnit> ModuleTemplate::make(std::vector<std::uint64_t>* sources) const {
    UsedSources used(files);
    const SourceLookup lookup = [&](std::string_view name) {
        if (sources != nullptr) {
            used.addFile(name);
        }
        return files.find(name);
    };
    GLINT_TRY(const auto flattened, flatten(origin, text, lookup, FlattenSide::Glsl));
    GlslUnit unit = dropUnused(cutDecided(flattened));
    if (sources != nullptr) {
        used.addItemsOf(flattened, false);
        // Names that macros paste together stand in no line; such items stay in the text.
        used.addItemsOf(unit, true);
        *sources = std::move(used).take();
    }
    return unit;
}

namespace {

constexpr std::string_view kTexts = "text";  // kind of entries of the cache
constexpr std::size_t kMostTexts = 4;        // of one template there

// Other versions of this program may make another text of the same sources.
std::string storedKey(const TextHash& key) {
    static const std::string kProgram = programIdentity();
    return Packer().add(kProgram).add(key.first).add(key.second).take();
}

}  // namespace

// The name of a case's module and the comments in it have the number of the case, which one case more changes
// for those behind it. Files may be included from beside the text.
TextHash WarmModules::keyOf(const ModuleTemplate& made) {
    const TextHash hash = hashOfText(essentialText(made.text));
    const std::string_view folder = std::string_view(made.origin).substr(0, made.origin.rfind('/') + 1);
    return {hash.first, base::hashBytes(base::asBytes(folder), hash.second)};
}

std::string WarmModules::pack(const Texts& texts) {
    Packer packer;
    std::size_t left = std::min(texts.size(), kMostTexts);
    packer.add(left);
    for (auto place = texts.begin(); left > 0; ++place, --left) {
        const Text& one = *place;
        packer.add(one.state).add(one.text.first).add(one.text.second).add(one.sources.size());
        for (const std::uint64_t source : one.sources) {
            packer.add(source);
        }
    }
    return packer.take();
}

WarmModules::Texts WarmModules::unpack(std::string_view bytes) {
    Unpacker unpacker(bytes);
    const auto number = [&] { return unpacker.number().value_or(0); };
    Texts texts(unpacker.count(4 * sizeof(std::uint64_t)).value_or(0));
    for (Text& one : texts) {
        one.state = number();
        one.text.first = number();
        one.text.second = number();
        one.sources.resize(unpacker.count(sizeof(std::uint64_t)).value_or(0));
        std::ranges::generate(one.sources, number);
    }
    return unpacker.atEnd() ? texts : Texts();
}

std::optional<TextHash> WarmModules::findText(const ModuleTemplate& made, const ModuleCache* cache) {
    const TextHash key = keyOf(made);
    std::unique_lock lock(mutex_);
    auto known = texts_.find(key);
    if (known == texts_.end()) {
        lock.unlock();
        Texts stored;
        if (cache != nullptr) {
            stored = unpack(cache->store().find(kTexts, storedKey(key)).value_or(""));
        }
        lock.lock();
        known = texts_.emplace(key, std::move(stored)).first;
    }
    const auto found = std::ranges::find_if(known->second, [&](const Text& candidate) {
        return made.files.stateOf(candidate.sources) == candidate.state;
    });
    if (found == known->second.end()) {
        return std::nullopt;
    }
    found->used = run_;
    return found->text;
}

void WarmModules::putText(const ModuleTemplate& made, std::vector<std::uint64_t> sources,
                          const TextHash& text, const ModuleCache* cache) {
    const TextHash key = keyOf(made);
    const std::uint64_t state = made.files.stateOf(sources);
    const std::lock_guard lock(mutex_);
    Texts& texts = texts_[key];
    texts.push_front({std::move(sources), state, text, run_});
    if (cache != nullptr) {
        cache->store().put(kTexts, storedKey(key), pack(texts));
    }
}

std::shared_ptr<const HashedModule> WarmModules::findModule(const TextHash& text) {
    const std::lock_guard lock(mutex_);
    const auto known = modules_.find(text);
    if (known == modules_.end()) {
        return nullptr;
    }
    known->second.used = run_;
    return known->second.module;
}

void WarmModules::putModule(const TextHash& text, std::shared_ptr<const HashedModule> module) {
    const std::lock_guard lock(mutex_);
    modules_[text] = {std::move(module), run_};
}

MaterialCodeOfCases& WarmModules::codeOfCases(const Plan& plan) {
    if (!codeOfCases_ || !codeOfCases_->isOf(plan)) {
        codeOfCases_.emplace(plan);
    }
    return *codeOfCases_;
}

void WarmModules::endRun() {
    const auto isOld = [&](const auto& entry) { return entry.used + kRuns < run_; };
    for (auto& [key, candidates] : texts_) {
        std::erase_if(candidates, isOld);
    }
    std::erase_if(texts_, [](const auto& entry) { return entry.second.empty(); });
    std::erase_if(modules_, [&](const auto& entry) { return isOld(entry.second); });
    ++run_;
}

std::string precisionDefines(package::ShadingPrecision precision) {
    // Without these, values without a precision take that of their neighbours, even mediump.
    return precision == package::ShadingPrecision::Half ? "precision highp float;\nprecision highp int;\n"
                                                        : "";
}

void insertDefines(std::string& text, const std::string& defines) {
    if (!defines.empty()) {
        text.insert(text.find('\n') + 1, defines + "#line 2\n");
    }
}

std::shared_ptr<ModuleSource> makePart(std::string name, std::vector<std::string> functions) {
    auto part = std::make_shared<ModuleSource>();
    part->stage = ShaderStage::Compute;
    part->name = std::move(name);
    part->link = LinkNames{std::move(functions), {}, false};
    return part;
}

void insertPartDefines(std::string& text, package::ShadingPrecision precision) {
    insertDefines(text,
                  precisionDefines(precision) + "#define GLINT_TRACER 0\n#define GLINT_RAY_GENERATION 0\n");
}

std::shared_ptr<ModuleSource> makeHead(const ModuleSource& module, std::vector<std::string> functions) {
    auto head = std::make_shared<ModuleSource>();
    head->key = module.key;
    head->stage = module.stage;
    head->name = module.name;
    head->link = LinkNames{{}, std::move(functions), true};
    return head;
}

void ModuleDrafts::add(std::shared_ptr<ModuleSource> module, std::string origin, std::string text,
                       std::shared_ptr<const SourceSet> own) {
    drafts_.push_back(
        {std::move(module), std::make_shared<const ModuleTemplate>(ModuleTemplate{
                                std::move(origin), std::move(text), {std::move(own), sources_}})});
}

Status ModuleDrafts::finish(const Draft& draft) const {
    const std::shared_ptr<const ModuleTemplate>& made = draft.made;
    const std::optional<TextHash> known = warm_.findText(*made, cache_);
    if (known && !all_) {
        draft.module->glsl = std::make_shared<const ModuleGlsl>(*known, [made] { return made->make(); });
        return okStatus();
    }
    std::vector<std::uint64_t> sources;
    GLINT_TRY(auto unit, made->make(known ? nullptr : &sources));
    draft.module->glsl = std::make_shared<const ModuleGlsl>(std::move(unit));
    if (!known) {
        warm_.putText(*made, std::move(sources), draft.module->glsl->hash(), cache_);
    }
    return okStatus();
}

Status ModuleDrafts::finish(int jobs) {
    std::vector<Status> results(drafts_.size(), okStatus());
    base::runParallel(drafts_.size(), jobs, [&](std::size_t i) {
        results[i] = finish(drafts_[i]);
        return results[i].ok();
    });
    for (const Status& result : results) {
        if (!result) {
            return result;
        }
    }
    return okStatus();
}

}  // namespace glint::compiler
