#include "spirv/lint.h"

#include "spirv/lint_flow.h"
#include "spirv/reader.h"

#include <fmt/format.h>
#include <glslang/SPIRV/spirv.hpp>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <map>
#include <optional>
#include <set>
#include <span>
#include <tuple>
#include <unordered_map>
#include <vector>

namespace glint::compiler {

namespace {

// This is gl_RayFlagsSkipAABBEXT of GLSL_EXT_ray_flags_primitive_culling.
constexpr std::uint32_t kSkipAabbs = spv::RayFlagsSkipAABBsKHRMask;
// This is gl_RayFlagsForceOpacityMicromap2StateEXT of GLSL_EXT_opacity_micromap. Headers of 2022 lack it.
constexpr std::uint32_t kTwoStates = 0x400;
constexpr std::uint32_t kOpaque = spv::RayFlagsOpaqueKHRMask;
constexpr std::uint32_t kFirstHit = spv::RayFlagsTerminateOnFirstHitKHRMask;

class QueryRules {
public:
    QueryRules(const FlowModule& module, const std::map<std::size_t, SpirvPlace>& places,
               std::vector<LintFinding>& findings)
        : module_(module), places_(places), findings_(findings) {}

    void judge(const FlowFunction& function) {
        for (std::size_t b = 0; b < function.blocks.size(); ++b) {
            for (std::size_t e = 0; e < function.blocks[b].events.size(); ++e) {
                if (function.blocks[b].events[e].act == QueryAct::Initialize) {
                    judgeInitialize(function, {b, e});
                }
            }
        }
        judgeLiveness(function);
    }

private:
    // A function may be inlined at several calls, so each of its findings is reported only once.
    void report(Severity severity, const std::string& rule, const QueryEvent& event, std::string message,
                std::string hint) {
        if (reported_.emplace(rule, event.origin, message).second) {
            const auto place = places_.find(event.origin);
            findings_.push_back({severity, rule, place == places_.end() ? SpirvPlace() : place->second,
                                 std::move(message), std::move(hint)});
        }
    }

    void judgeInitialize(const FlowFunction& function, EventPlace start) {
        const std::vector<EventPlace> after = eventsAfter(function, start);
        std::vector<EventPlace> proceeds;
        bool passedOn = false;
        for (const EventPlace place : after) {
            const QueryAct act = at(function, place).act;
            passedOn = passedOn || act == QueryAct::PassedOn;
            if (act == QueryAct::Proceed) {
                proceeds.push_back(place);
            }
        }
        if (proceeds.empty() && !passedOn) {
            report(Severity::Warning, "query-proceed-missing", at(function, start),
                   "a ray query is initialised, but no path proceeds",
                   "remove it, or call rayQueryProceedEXT");
        }
        judgeProceeds(function, start, proceeds);
        judgeFlags(function, start, after);
        judgeStructure(at(function, start));
    }

    void judgeProceeds(const FlowFunction& function, EventPlace start,
                       const std::vector<EventPlace>& proceeds) {
        if (proceeds.size() > 1) {
            report(Severity::Error, "query-proceeds", at(function, start),
                   fmt::format("{} OpRayQueryProceedKHR can follow one OpRayQueryInitializeKHR",
                               proceeds.size()),
                   "call rayQueryProceedEXT at one place after each initialise");
        }
        for (const EventPlace proceed : proceeds) {
            if (canAvoid(function, start, proceed)) {
                report(Severity::Error, "query-proceed-conditional", at(function, proceed),
                       "OpRayQueryProceedKHR is not on every path from its OpRayQueryInitializeKHR",
                       "proceed right after the initialise, and put the condition around both");
            } else if (repeats(function, proceed)) {
                report(Severity::Warning, "query-proceed-loop", at(function, proceed),
                       "OpRayQueryProceedKHR runs in a loop over candidates, as alpha tests need",
                       "where hits may be opaque, set gl_RayFlagsOpaqueEXT and proceed once, without a loop");
            }
        }
    }

    void judgeFlags(const FlowFunction& function, EventPlace start, const std::vector<EventPlace>& after) {
        const QueryEvent& initialize = at(function, start);
        const std::uint32_t* flags = module_.findConstant(initialize.flags);
        if (flags == nullptr) {
            report(Severity::Warning, "query-flags", initialize, "ray flags are not a constant",
                   "pass a constant, so that the compiler can leave out what it excludes");
            return;
        }
        const bool loops = std::ranges::any_of(after, [&](EventPlace place) {
            return at(function, place).act == QueryAct::Proceed && repeats(function, place);
        });
        // A loop over candidates needs those that are not opaque, and query-proceed-loop reports it already.
        if ((*flags & kOpaque) == 0 && !loops) {
            report(Severity::Warning, "query-flags", initialize,
                   fmt::format("ray flags {:#x} lack Opaque (0x1)", *flags), "add gl_RayFlagsOpaqueEXT");
        }
        if ((*flags & kSkipAabbs) == 0) {
            report(Severity::Warning, "query-flags", initialize,
                   fmt::format("ray flags {:#x} lack SkipAABBs (0x200)", *flags),
                   "add gl_RayFlagsSkipAABBEXT (GL_EXT_ray_flags_primitive_culling; device feature "
                   "rayTraversalPrimitiveCulling)");
        }
        if ((*flags & kTwoStates) != 0) {
            report(
                Severity::Warning, "query-micromap-states", initialize,
                fmt::format("ray flags {:#x} have ForceOpacityMicromap2State (0x400): micro-triangles whose "
                            "state is unknown are decided without their alpha test",
                            *flags),
                "leave the flag away unless the error in the picture is meant");
        }
        if ((*flags & kFirstHit) == 0 && readsTypeAlone(function, after)) {
            report(Severity::Note, "query-flags", initialize,
                   fmt::format("ray flags {:#x} lack TerminateOnFirstHit (0x4), although the shader reads "
                               "only whether there is a hit",
                               *flags),
                   "add gl_RayFlagsTerminateOnFirstHitEXT if any hit will do");
        }
    }

    void judgeStructure(const QueryEvent& initialize) {
        constexpr const char* kLoadBeside =
            "load it directly before each OpRayQueryInitializeKHR; optimisers merge such loads";
        if (initialize.structureIndexed) {
            report(Severity::Warning, "query-structure-index", initialize,
                   "the acceleration structure is an element of an array, and its index is no constant",
                   "bind it by itself, or make the index a specialisation constant: where a compiler can't "
                   "prove that the index is the same for all threads, traversal is slow");
        }
        if (!loads_.insert(initialize.structure).second) {
            report(Severity::Warning, "query-structure-load", initialize,
                   "several ray queries share one load of the acceleration structure", kLoadBeside);
        } else if (initialize.structureElsewhere) {
            report(Severity::Warning, "query-structure-load", initialize,
                   "the acceleration structure is loaded in another block than the one that initialises the "
                   "query",
                   kLoadBeside);
        }
    }

    static bool readsTypeAlone(const FlowFunction& function, const std::vector<EventPlace>& after) {
        const auto any = [&](QueryAct act) {
            return std::ranges::any_of(after,
                                       [&](EventPlace place) { return at(function, place).act == act; });
        };
        return any(QueryAct::ReadType) && !any(QueryAct::ReadHit) && !any(QueryAct::PassedOn);
    }

    using ObjectSet = std::vector<bool>;

    // Returns the objects that may be initialised at the start of each block.
    static std::vector<ObjectSet> initializedAtEntry(const FlowFunction& function) {
        std::vector<ObjectSet> sets(function.blocks.size(), ObjectSet(function.objects.size(), false));
        bool changed = true;
        while (changed) {
            changed = false;
            for (std::size_t b = 0; b < function.blocks.size(); ++b) {
                ObjectSet set = sets[b];
                for (const QueryEvent& event : function.blocks[b].events) {
                    // A function that gets an object passed may initialise it.
                    set[event.object] = set[event.object] || event.act == QueryAct::Initialize ||
                                        event.act == QueryAct::PassedOn;
                }
                for (const std::size_t successor : function.blocks[b].successors) {
                    changed = merge(sets[successor], set) || changed;
                }
            }
        }
        return sets;
    }

    // Returns, for the end of each block, the objects that may still be used without being initialised again.
    static std::vector<ObjectSet> usedAfterExit(const FlowFunction& function) {
        std::vector<ObjectSet> sets(function.blocks.size(), ObjectSet(function.objects.size(), false));
        bool changed = true;
        while (changed) {
            changed = false;
            for (std::size_t b = function.blocks.size(); b-- > 0;) {
                for (const std::size_t successor : function.blocks[b].successors) {
                    ObjectSet set = sets[successor];
                    const std::vector<QueryEvent>& events = function.blocks[successor].events;
                    for (std::size_t e = events.size(); e-- > 0;) {
                        set[events[e].object] = events[e].act != QueryAct::Initialize;
                    }
                    changed = merge(sets[b], set) || changed;
                }
            }
        }
        return sets;
    }

    // Returns whether `target` grew.
    static bool merge(ObjectSet& target, const ObjectSet& source) {
        bool grew = false;
        for (std::size_t i = 0; i < source.size(); ++i) {
            grew = grew || (source[i] && !target[i]);
            target[i] = target[i] || source[i];
        }
        return grew;
    }

    // An object is live between its initialise and its last use.
    void judgeLiveness(const FlowFunction& function) {
        const std::vector<ObjectSet> initialized = initializedAtEntry(function);
        const std::vector<ObjectSet> used = usedAfterExit(function);
        for (std::size_t b = 0; b < function.blocks.size(); ++b) {
            const std::vector<QueryEvent>& events = function.blocks[b].events;
            ObjectSet before = initialized[b];
            for (std::size_t e = 0; e < events.size(); ++e) {
                if (events[e].act == QueryAct::Initialize) {
                    judgeOthers(function, {b, e}, before, used[b]);
                }
                before[events[e].object] = before[events[e].object] ||
                                           events[e].act == QueryAct::Initialize ||
                                           events[e].act == QueryAct::PassedOn;
            }
        }
    }

    // Reports the other objects that are live where `start` initialises its object.
    void judgeOthers(const FlowFunction& function, EventPlace start, const ObjectSet& initialized,
                     ObjectSet usedLater) {
        const std::vector<QueryEvent>& events = function.blocks[start.block].events;
        for (std::size_t e = events.size(); --e > start.event;) {
            usedLater[events[e].object] = events[e].act != QueryAct::Initialize;
        }
        const std::size_t own = events[start.event].object;
        if (function.objects[own].dynamic) {
            report(Severity::Error, "query-live-objects", events[start.event],
                   "a ray query of an array is chosen at run time, so all of them are live",
                   "use one ray query");
        }
        std::size_t others = 0;
        for (std::size_t object = 0; object < function.objects.size(); ++object) {
            others += object != own && initialized[object] && usedLater[object] ? 1 : 0;
        }
        if (others > 0) {
            report(Severity::Error, "query-live-objects", events[start.event],
                   fmt::format("a ray query is initialised while {} yet to be read",
                               others == 1 ? "another is" : fmt::format("{} others are", others)),
                   "copy what is needed of a hit, then initialise the next query");
        }
    }

    const FlowModule& module_;
    const std::map<std::size_t, SpirvPlace>& places_;
    std::vector<LintFinding>& findings_;
    std::set<std::tuple<std::string, std::size_t, std::string>> reported_;
    std::set<std::uint32_t> loads_;  // of acceleration structures
};

void lintQueries(std::span<const std::uint32_t> words, const std::map<std::size_t, SpirvPlace>& places,
                 std::vector<LintFinding>& findings) {
    const std::vector<std::uint32_t> prepared = prepareForLint(words);
    const FlowModule module = readFlow(prepared);
    QueryRules rules(module, places, findings);
    for (const FlowFunction& function : module.functions) {
        rules.judge(function);
    }
}

// Names the stages that a trace starts: a trace in one of them is nested in another trace.
const char* nameHitStage(std::uint32_t model) {
    switch (model) {
        case spv::ExecutionModelClosestHitKHR:
            return "closest-hit";
        case spv::ExecutionModelAnyHitKHR:
            return "any-hit";
        case spv::ExecutionModelMissKHR:
            return "miss";
        default:
            return nullptr;
    }
}

// Returns the offsets of traces, by function.
std::map<std::uint32_t, std::vector<std::size_t>> findTraces(std::span<const std::uint32_t> words) {
    std::map<std::uint32_t, std::vector<std::size_t>> traces;
    std::uint32_t function = 0;
    for (const SpirvInstruction& instruction : SpirvInstructions(words)) {
        if (instruction.opcode == spv::OpFunction) {
            function = instruction.operands[1];
        } else if (isTraceInstruction(instruction.opcode)) {
            traces[function].push_back(instruction.at);
        }
    }
    return traces;
}

void judgeTraces(std::span<const std::uint32_t> words, const std::map<std::size_t, SpirvPlace>& places,
                 std::vector<LintFinding>& findings) {
    const std::map<std::uint32_t, std::vector<std::size_t>> traces = findTraces(words);
    if (traces.empty()) {
        return;
    }
    const std::vector<SpirvFunction> functions = findFunctions(words);
    for (const SpirvEntryPoint& entry : findEntryPoints(words)) {
        const char* const stage = nameHitStage(entry.model);
        if (stage == nullptr) {
            continue;
        }
        for (const std::uint32_t function : reachableFrom(entry.function, functions)) {
            const auto found = traces.find(function);
            for (const std::size_t offset :
                 found == traces.end() ? std::vector<std::size_t>() : found->second) {
                findings.push_back(
                    {Severity::Warning, "trace-from-hit", places.at(offset),
                     fmt::format("a {} shader traces a ray: recursion", stage),
                     "return what the next ray needs, and trace it in the ray generation shader"});
            }
        }
    }
}

// The sizes of types in bytes, without padding: the least that the driver has to carry. A bool counts as one
// word.
class TypeSizes {
public:
    void visit(const SpirvInstruction& it) {
        constexpr std::uint64_t kBitsPerByte = 8;
        constexpr std::uint64_t kBoolBytes = 4;
        constexpr std::uint64_t kPointerBytes = 8;
        switch (it.opcode) {
            case spv::OpTypeBool:
                bytes_[it.operands[0]] = kBoolBytes;
                break;
            case spv::OpTypeInt:
            case spv::OpTypeFloat:
                bytes_[it.operands[0]] = it.operands[1] / kBitsPerByte;
                break;
            case spv::OpTypeVector:
            case spv::OpTypeMatrix:
                bytes_[it.operands[0]] = multiply(bytes_[it.operands[1]], it.operands[2]);
                break;
            case spv::OpConstant:
            case spv::OpSpecConstant:
                constants_[it.operands[1]] = it.operands[2];
                break;
            case spv::OpTypeArray:
                bytes_[it.operands[0]] = multiply(bytes_[it.operands[1]], constants_[it.operands[2]]);
                break;
            case spv::OpTypeStruct:
                bytes_[it.operands[0]] = 0;
                for (const std::uint32_t member : it.operands.subspan(1)) {
                    // The sum can't overflow: each term is below 2^48, and there are fewer than 2^16 terms.
                    bytes_[it.operands[0]] += std::min(bytes_[member], kLimit);
                }
                break;
            case spv::OpTypePointer:
                bytes_[it.operands[0]] = kPointerBytes;
                pointees_[it.operands[0]] = it.operands[2];
                break;
            default:
                break;
        }
    }
    std::uint64_t pointeeBytes(std::uint32_t pointerType) {
        return bytes_[pointees_[pointerType]];
    }

private:
    static constexpr std::uint64_t kLimit = 1ULL << 48U;

    static std::uint64_t multiply(std::uint64_t bytes, std::uint64_t count) {
        return count != 0 && bytes > kLimit / count ? kLimit : bytes * count;
    }

    std::unordered_map<std::uint32_t, std::uint64_t> bytes_;
    std::unordered_map<std::uint32_t, std::uint64_t> constants_;
    std::unordered_map<std::uint32_t, std::uint32_t> pointees_;
};

void judgePayloads(std::span<const std::uint32_t> words, std::vector<LintFinding>& findings) {
    constexpr std::uint64_t kMaxBytes = 64;
    TypeSizes sizes;
    for (const SpirvInstruction& it : SpirvInstructions(words)) {
        sizes.visit(it);
        if (it.opcode != spv::OpVariable) {
            continue;
        }
        const std::uint32_t storage = it.operands[2];
        const bool own = storage == spv::StorageClassRayPayloadKHR;
        if (!own && storage != spv::StorageClassIncomingRayPayloadKHR) {
            continue;
        }
        const std::uint64_t bytes = sizes.pointeeBytes(it.operands[0]);
        // The payload of a hit shader is declared by the shader that traces, and reported there, unless it is
        // large.
        if (own || bytes > kMaxBytes) {
            findings.push_back({bytes > kMaxBytes ? Severity::Warning : Severity::Note, "payload-bytes",
                                SpirvPlace{{}, {}, it.operands[1], it.at},
                                fmt::format("the ray payload has {} bytes", bytes),
                                bytes > kMaxBytes ? fmt::format("pack it into {} bytes or fewer", kMaxBytes)
                                                  : std::string()});
        }
    }
}

std::string nameModel(std::uint32_t model) {
    switch (model) {
        case spv::ExecutionModelVertex:
            return "Vertex";
        case spv::ExecutionModelFragment:
            return "Fragment";
        case spv::ExecutionModelGLCompute:
            return "GLCompute";
        case spv::ExecutionModelRayGenerationKHR:
            return "RayGenerationKHR";
        case spv::ExecutionModelIntersectionKHR:
            return "IntersectionKHR";
        case spv::ExecutionModelAnyHitKHR:
            return "AnyHitKHR";
        case spv::ExecutionModelClosestHitKHR:
            return "ClosestHitKHR";
        case spv::ExecutionModelMissKHR:
            return "MissKHR";
        case spv::ExecutionModelCallableKHR:
            return "CallableKHR";
        default:
            return fmt::format("model {}", model);
    }
}

}  // namespace

Result<SpirvLint> lintSpirv(std::span<const std::uint32_t> words) {
    GLINT_TRY(const auto statistics, measureSpirv(words));
    GLINT_TRY_DO(checkSpirv(words));
    SpirvLint lint;
    lint.statistics = statistics;
    for (const SpirvEntryPoint& entry : findEntryPoints(words)) {
        const std::string stage = nameModel(entry.model);
        if (std::ranges::find(lint.stages, stage) == lint.stages.end()) {
            lint.stages.push_back(stage);
        }
    }
    const std::map<std::size_t, SpirvPlace> places = findPlaces(words);
    if (statistics.rayQueries > 0) {
        lintQueries(words, places, lint.findings);
    }
    judgeTraces(words, places, lint.findings);
    judgePayloads(words, lint.findings);
    std::ranges::stable_sort(lint.findings, {},
                             [](const LintFinding& finding) { return finding.place.offset; });
    return lint;
}

}  // namespace glint::compiler
