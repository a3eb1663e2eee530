// Tests shader IDs that outlive changes of the scene, and the text that keeps them.
#include "plan/lock.h"

#include "resolve/lock_file.h"
#include "support/features.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <set>
#include <string>
#include <utility>
#include <variant>
#include <vector>

namespace {

using namespace glint;

constexpr unsigned kLockSeed = 20250621;
const materials::FeatureMask kLockNormals = bit("normals");
const materials::FeatureMask kUnlit = bit("unlit");
const materials::FeatureMask kLockTextured = kLockNormals | bit("baseColorTexture") | bit("texCoord0");
const materials::FeatureMask kLockCoated = kLockNormals | bit("clearcoat");
constexpr compiler::MergePolicy kLockPolicies[] = {compiler::MergePolicy::None, compiler::MergePolicy::Family,
                                                   compiler::MergePolicy::All, compiler::MergePolicy::Auto,
                                                   compiler::MergePolicy::Profile};

// A material and the primitive that has it.
struct Piece {
    materials::Material material;
    materials::PrimitiveInputs inputs;
};

Piece randomPiece(std::mt19937& random) {
    Piece piece;
    const auto chance = [&] { return (random() & 3U) == 0; };
    if (chance()) {
        piece.material.give("KHR_materials_unlit");
    }
    piece.material["clearcoatFactor"] = chance() ? 1.0F : 0.0F;
    piece.material["sheenColorFactor"][0] = chance() ? 1.0F : 0.0F;
    piece.material.texture("baseColorTexture").texture = chance() ? 0 : -1;
    piece.material.texture("emissiveTexture").texture = chance() ? 0 : -1;
    piece.material["emissiveFactor"] = {1.0F, 1.0F, 1.0F};
    piece.inputs.hasNormals = !chance();
    piece.inputs.hasTexCoords0 = true;
    piece.inputs.expectedHits = static_cast<double>(1 + random() % 1000);
    return piece;
}

compiler::Plan planOf(const std::vector<Piece>& pieces, const compiler::PlanOptions& options) {
    std::vector<materials::Material> materials;
    std::vector<materials::PrimitiveInputs> primitives;
    for (std::size_t i = 0; i < pieces.size(); ++i) {
        materials.push_back(pieces[i].material);
        primitives.push_back(pieces[i].inputs);
        primitives.back().primitive = static_cast<int>(i);
        primitives.back().material = static_cast<int>(i);
    }
    return makePlan(materials, primitives, options);
}

// Returns each case's keys as masks, by shader ID.
std::map<int, std::set<materials::FeatureMask>> keysById(const compiler::Plan& plan) {
    std::map<int, std::set<materials::FeatureMask>> byId;
    for (const compiler::Key& key : plan.keys) {
        byId[key.shaderId].insert(key.mask);
    }
    return byId;
}

// Checks what every plan promises about its IDs.
void checkIds(const compiler::Plan& plan) {
    ASSERT_EQ(caseCount(plan), keysById(plan).size());
    std::set<std::string> names;
    for (std::size_t i = 0; i < plan.cases.size(); ++i) {
        const compiler::Case& shaderCase = plan.cases[i];
        EXPECT_EQ(shaderCase.shaderId, static_cast<int>(i));
        EXPECT_TRUE(names.insert(shaderCase.name).second) << shaderCase.name;
        EXPECT_FALSE(shaderCase.isRetired() && (shaderCase.always | shaderCase.sometimes) != 0);
        for (const int key : shaderCase.keys) {
            EXPECT_EQ(plan.keys[static_cast<std::size_t>(key)].shaderId, shaderCase.shaderId);
        }
    }
    ASSERT_TRUE(plan.cases.empty() || !plan.cases.back().isRetired());
}

void change(std::vector<Piece>& pieces, std::mt19937& random) {
    const std::size_t place = pieces.empty() ? 0 : random() % pieces.size();
    switch (random() % 4) {
        case 0:
        case 1:
            pieces.insert(pieces.begin() + static_cast<long>(place), randomPiece(random));
            break;
        case 2:
            if (!pieces.empty()) {
                pieces.erase(pieces.begin() + static_cast<long>(place));
            }
            break;
        default:
            std::ranges::shuffle(pieces, random);
    }
}

// A case keeps its ID if no other case has keys with that ID, and none of its keys has another ID.
void checkSurvivors(const compiler::LockedIds& earlier, const compiler::Plan& plan) {
    std::map<int, std::set<int>> successors;
    std::map<int, std::set<int>> predecessors;
    for (const auto& [id, keys] : keysById(plan)) {
        for (const materials::FeatureMask& mask : keys) {
            if (const auto found = earlier.find(mask); found != earlier.end()) {
                successors[found->second].insert(id);
                predecessors[id].insert(found->second);
            }
        }
    }
    for (const auto& [id, next] : successors) {
        if (next.size() == 1 && predecessors[*next.begin()].size() == 1) {
            EXPECT_EQ(*next.begin(), id);
        }
    }
}

TEST(Lock, IdsSurviveRandomChangesUnderEveryPolicy) {
    RecordProperty("seed", kLockSeed);
    for (const compiler::MergePolicy merge : kLockPolicies) {
        SCOPED_TRACE(nameOf(merge));
        std::mt19937 random(kLockSeed);
        std::vector<Piece> pieces;
        compiler::PlanOptions options{{}, merge};
        options.maxShaders =
            merge == compiler::MergePolicy::Auto || merge == compiler::MergePolicy::Profile ? 6 : 0;
        for (int step = 0; step < 150; ++step) {
            change(pieces, random);
            for (const Piece& piece : pieces) {
                options.hits[compiler::makeKey(piece.material, piece.inputs, options.keys)] = random() % 50;
            }
            const compiler::Plan plan = planOf(pieces, options);
            checkIds(plan);
            checkSurvivors(options.lockedIds, plan);
            EXPECT_EQ(keysById(plan), keysById(planOf(pieces, options))) << "not deterministic";
            const compiler::LockUpdate update = updateLock(options.lockedIds, plan, false);
            options.lockedIds = update.ids;
            // Once the IDs are kept, planning again changes nothing.
            const compiler::LockUpdate again = updateLock(update.ids, planOf(pieces, options), false);
            EXPECT_FALSE(again.changes(update.ids));
            EXPECT_TRUE(again.added.empty() && again.moved.empty());
            if (HasFailure()) {
                FAIL() << "in step " << step;
            }
        }
    }
}

// With `none` each key is a case, so a key that ever had an ID keeps it forever.
TEST(Lock, KeysComeBackWithTheirIds) {
    RecordProperty("seed", kLockSeed);
    std::mt19937 random(kLockSeed);
    std::vector<Piece> pieces;
    compiler::PlanOptions options{{}, compiler::MergePolicy::None};
    compiler::LockedIds everSeen;
    for (int step = 0; step < 200; ++step) {
        change(pieces, random);
        const compiler::Plan plan = planOf(pieces, options);
        for (const compiler::Key& key : plan.keys) {
            EXPECT_EQ(everSeen.emplace(key.mask, key.shaderId).first->second, key.shaderId);
        }
        options.lockedIds = updateLock(options.lockedIds, plan, false).ids;
    }
    EXPECT_EQ(options.lockedIds, everSeen);
    EXPECT_GT(everSeen.size(), 20U);
}

TEST(Lock, OrderOfMaterialsMeansNothing) {
    std::mt19937 random(kLockSeed);
    std::vector<Piece> pieces;
    for (int i = 0; i < 30; ++i) {
        pieces.push_back(randomPiece(random));
        // The values are equal, so that sums of shares do not depend on their order.
        pieces.back().inputs.expectedHits = 1.0;
    }
    for (const compiler::MergePolicy merge : kLockPolicies) {
        compiler::PlanOptions options{{}, merge};
        options.lockedIds = {{kLockNormals, 7}, {kLockTextured, 3}, {kLockCoated, 7}};
        const auto expected = keysById(planOf(pieces, options));
        std::ranges::shuffle(pieces, random);
        EXPECT_EQ(keysById(planOf(pieces, options)), expected) << nameOf(merge);
    }
}

Piece plain() {
    Piece piece;
    piece.inputs.hasNormals = true;
    piece.inputs.hasTexCoords0 = true;
    return piece;
}
Piece textured() {
    Piece piece = plain();
    piece.material.texture("baseColorTexture").texture = 0;
    return piece;
}
Piece coated() {
    Piece piece = plain();
    piece.material["clearcoatFactor"] = 1.0F;
    return piece;
}

TEST(Lock, RetiredIdsAreLeftAlone) {
    compiler::PlanOptions options{{}, compiler::MergePolicy::None};
    options.lockedIds = {{kUnlit, 0}, {kLockNormals, 4}};
    const compiler::Plan plan = planOf({plain(), coated()}, options);
    checkIds(plan);
    ASSERT_EQ(plan.cases.size(), 5U);
    EXPECT_EQ(caseCount(plan), 2U);
    EXPECT_EQ(plan.cases[0].name, "Retired_0");
    EXPECT_EQ(plan.cases[4].always, kLockNormals);
    EXPECT_EQ(plan.cases[1].always, kLockCoated);
    const compiler::LockUpdate update = updateLock(options.lockedIds, plan, false);
    EXPECT_EQ(update.ids, (compiler::LockedIds{{kUnlit, 0}, {kLockNormals, 4}, {kLockCoated, 1}}));
    EXPECT_EQ(update.stale, std::vector<materials::FeatureMask>{kUnlit});
    EXPECT_EQ(update.added, std::vector<materials::FeatureMask>{kLockCoated});
    const compiler::LockUpdate pruned = updateLock(options.lockedIds, plan, true);
    EXPECT_EQ(pruned.ids, (compiler::LockedIds{{kLockNormals, 4}, {kLockCoated, 1}}));
    EXPECT_EQ(pruned.stale, update.stale);
}

TEST(Lock, MoreKeysThenMoreHitsDecideWhoKeepsAnId) {
    std::vector<compiler::WeightedKey> keys{{1, 0.1}, {2, 0.1}, {4, 0.2}, {8, 0.6}};
    const compiler::LockedIds all{{1, 5}, {2, 5}, {4, 5}, {8, 5}};
    const std::vector<compiler::CaseKeys> pair{{{0, 1}}, {{2}}, {{3}}};
    EXPECT_EQ(assignShaderIds(keys, pair, all), (std::vector<int>{5, 0, 1}));
    const std::vector<compiler::CaseKeys> single{{{0}}, {{1}}, {{2}}, {{3}}};
    EXPECT_EQ(assignShaderIds(keys, single, all), (std::vector<int>{0, 1, 2, 5}));
    for (compiler::WeightedKey& key : keys) {
        key.share = 0.25;
    }
    EXPECT_EQ(assignShaderIds(keys, single, all), (std::vector<int>{5, 0, 1, 2}));
    // If two IDs have one key each, the lower ID is taken. A case that loses one takes the other ID that it
    // has.
    EXPECT_EQ(assignShaderIds(keys, {pair}, compiler::LockedIds{{1, 9}, {2, 6}}),
              (std::vector<int>{6, 0, 1}));
    EXPECT_EQ(assignShaderIds(keys, std::vector<compiler::CaseKeys>{{{0, 1}}, {{2, 3}}},
                              compiler::LockedIds{{1, 6}, {2, 6}, {4, 6}, {8, 7}}),
              (std::vector<int>{6, 7}));
}

// Two branches gave different keys the same ID.
TEST(Lock, SecondClaimOfAnIdGetsANewOne) {
    compiler::PlanOptions options{{}, compiler::MergePolicy::None};
    options.lockedIds = {{kLockNormals, 0}, {kLockTextured, 1}, {kLockCoated, 1}};
    const compiler::Plan plan = planOf({plain(), textured(), coated()}, options);
    const compiler::LockUpdate update = updateLock(options.lockedIds, plan, false);
    ASSERT_EQ(update.moved.size(), 1U);
    EXPECT_EQ(update.moved[0].from, 1);
    EXPECT_EQ(update.moved[0].to, 2);
    EXPECT_TRUE(update.moved[0].lostId);
    EXPECT_TRUE(update.changes(options.lockedIds));
    // The keys of a family always share an ID; the lower of two stays.
    options.merge = compiler::MergePolicy::Family;
    const compiler::LockUpdate merged =
        updateLock(options.lockedIds, planOf({plain(), textured()}, options), false);
    ASSERT_EQ(merged.moved.size(), 1U);
    EXPECT_EQ(merged.moved[0].to, 0);
    EXPECT_FALSE(merged.moved[0].lostId);
}

compiler::LockText parsed(const std::string& text) {
    const std::variant<compiler::LockText, compiler::LockTextError> result = compiler::parseLock(text);
    if (const auto* error = std::get_if<compiler::LockTextError>(&result)) {
        ADD_FAILURE() << error->line << ": " << error->message;
        return {};
    }
    return std::get<compiler::LockText>(result);
}

compiler::LockTextError failed(const std::string& text) {
    const std::variant<compiler::LockText, compiler::LockTextError> result = compiler::parseLock(text);
    const auto* error = std::get_if<compiler::LockTextError>(&result);
    EXPECT_NE(error, nullptr) << text;
    return error != nullptr ? *error : compiler::LockTextError{};
}

compiler::LockedIds randomIds(std::mt19937& random, std::size_t count) {
    materials::FeatureMask known = 0;
    for (const materials::Feature& info : materials::builtinMaterialModel().features) {
        known |= info.mask();
    }
    compiler::LockedIds ids;
    while (ids.size() < count) {
        const materials::FeatureMask mask = (std::uint64_t{random()} << 32U | random()) & known;
        ids[mask & (std::uint64_t{random()} << 32U | random())] = static_cast<int>(random() % 65536);
    }
    return ids;
}

TEST(LockText, ReadsBackWhatItWrites) {
    RecordProperty("seed", kLockSeed);
    std::mt19937 random(kLockSeed);
    for (const std::size_t count : {0U, 1U, 2U, 30U, 500U}) {
        const compiler::LockedIds ids = randomIds(random, count);
        const compiler::LockText text = parsed(compiler::formatLock(ids));
        EXPECT_EQ(text.ids, ids);
        EXPECT_TRUE(text.repeated.empty());
    }
    EXPECT_EQ(parsed(compiler::formatLock({{0, 3}})).ids, (compiler::LockedIds{{0, 3}}));
}

TEST(LockText, IsSortedByFeatures) {
    const std::string text =
        compiler::formatLock({{kUnlit, 0}, {kLockTextured, 2}, {0, 9}, {kLockNormals, 1}});
    const std::string keys = text.substr(text.find("version"));
    EXPECT_EQ(keys, "version 1\n9 -\n2 baseColorTexture texCoord0 normals\n1 normals\n0 unlit\n");
    EXPECT_TRUE(text.starts_with("# "));
}

// Such a file results from a merge that takes both sides, and from an editor of another system.
TEST(LockText, OrderRepetitionAndLineEndsMeanNothing) {
    const compiler::LockText text = parsed(
        "\xEF\xBB\xBF# mine\r\nversion 1\r\n4 normals clearcoat\r\n\r\n# theirs\nversion 1\n"
        "  1\tnormals \n4 clearcoat normals\n0 unlit");
    EXPECT_EQ(text.ids, (compiler::LockedIds{{kUnlit, 0}, {kLockNormals, 1}, {kLockCoated, 4}}));
    EXPECT_TRUE(text.repeated.empty());
}

TEST(LockText, LowerOfTwoIdsOfAKeyCounts) {
    const compiler::LockText text = parsed("version 1\n7 unlit\n3 unlit\n5 unlit\n");
    EXPECT_EQ(text.ids, (compiler::LockedIds{{kUnlit, 3}}));
    ASSERT_EQ(text.repeated.size(), 2U);
    EXPECT_EQ(text.repeated[0].line, 3);
    EXPECT_EQ(text.repeated[0].ignored, 7);
    EXPECT_EQ(text.repeated[1].kept, 3);
    EXPECT_EQ(text.repeated[1].ignored, 5);
}

TEST(LockText, MistakesHaveTheirLines) {
    const std::vector<std::pair<std::string, std::pair<int, std::string>>> mistakes{
        {"", {1, "ends without"}},
        {"# only a comment\n\n", {2, "ends without"}},
        {"\n0 unlit\n", {2, "comes before"}},
        {"version 2\n", {1, "\"2\""}},
        {"version\n", {1, "version"}},
        {"version 1 1\n", {1, "version"}},
        {"version 1\n<<<<<<< HEAD\n0 unlit\n", {2, "merge conflict"}},
        {"version 1\n0 unlit\n=======\n", {3, "merge conflict"}},
        {"version 1\n||||||| base\n", {2, "merge conflict"}},
        {"<<<<<<< HEAD\n", {1, "merge conflict"}},
        {"version 1\n>>>>>>> theirs", {2, "merge conflict"}},
        {"version 1\n-1 unlit\n", {2, "\"-1\" is no shader ID"}},
        {"version 1\n65536 unlit\n", {2, "\"65536\" is no shader ID"}},
        {"version 1\n99999999999999999999 unlit\n", {2, "is no shader ID"}},
        {"version 1\nunlit 0\n", {2, "\"unlit\" is no shader ID"}},
        {"version 1\n0\n", {2, "no features"}},
        {"version 1\n0 - unlit\n", {2, "\"unlit\" follows"}},
        {"version 1\n0 unlit clearcaot\n", {2, "\"clearcaot\" is no feature"}},
    };
    for (const auto& [text, expected] : mistakes) {
        const compiler::LockTextError error = failed(text);
        EXPECT_EQ(error.line, expected.first) << text;
        EXPECT_NE(error.message.find(expected.second), std::string::npos) << text << ": " << error.message;
        EXPECT_FALSE(error.hint.empty()) << text;
    }
    EXPECT_EQ(failed("version 1\n0 unlit clearcaot\n").unknownFeature, "clearcaot");
}

// Any file is read, or refused with the number of a line, in printable words.
TEST(LockText, RandomEditsAreReadOrRefused) {
    RecordProperty("seed", kLockSeed);
    std::mt19937 random(kLockSeed);
    const std::string whole = compiler::formatLock(randomIds(random, 20));
    const std::string_view pieces[] = {"<<<<<<<",   "version 1\n", "version 9", "-",    "\n", "\r", " ",
                                       "999999999", "unlit",       "#",         "\xFF", "",   "0",  "\t"};
    int accepted = 0;
    int refused = 0;
    for (int round = 0; round < 20'000; ++round) {
        std::string text = whole;
        for (std::size_t edits = 1 + random() % 3; edits > 0; --edits) {
            const std::size_t place = random() % (text.size() + 1);
            const std::size_t erased = random() % 3 == 0 ? random() % 60 : random() % 2;
            text.replace(place, erased, pieces[random() % std::size(pieces)]);
        }
        text += random() % 8 == 0 ? std::string(1, '\0') : "";
        const std::variant<compiler::LockText, compiler::LockTextError> result = compiler::parseLock(text);
        if (const auto* error = std::get_if<compiler::LockTextError>(&result)) {
            ++refused;
            const auto lines = 1 + std::ranges::count(text, '\n');
            ASSERT_TRUE(error->line >= 1 && error->line <= lines) << text;
            ASSERT_TRUE(std::ranges::all_of(error->message, [](char c) { return c >= ' ' && c <= '~'; }));
        } else {
            ++accepted;
            const compiler::LockedIds& ids = std::get<compiler::LockText>(result).ids;
            ASSERT_EQ(parsed(compiler::formatLock(ids)).ids, ids);
        }
    }
    EXPECT_GT(accepted, 300);
    EXPECT_GT(refused, 1000);
}

}  // namespace
