// The control flow of a function, reduced to its events on ray query objects.
#pragma once

#include "spirv/lint_finding.h"
#include "spirv/reader.h"

#include <glint/result.h>

#include <cstddef>
#include <cstdint>
#include <map>
#include <span>
#include <string>
#include <unordered_map>
#include <utility>
#include <vector>

namespace glint::compiler {

// A variable of type OpTypeRayQueryKHR, or an element of an array of them.
struct QueryObject {
    std::uint32_t variable = 0;
    std::vector<std::uint32_t> indices;  // constant indices
    bool dynamic = false;                // indexed by a variable: it may be any element
    bool operator==(const QueryObject&) const = default;
};

enum class QueryAct {
    Initialize,
    Proceed,
    ReadType,  // reads whether there is a committed hit
    ReadHit,   // reads anything else of a committed hit
    Other,     // candidates, the ray itself, or terminate
    PassedOn,  // passed to a function that could not be inlined
};

struct QueryEvent {
    QueryAct act = QueryAct::Other;
    std::size_t object = 0;  // index into FlowFunction::objects
    std::size_t origin = 0;  // offset of the instruction in the original module
    // For Initialize only:
    std::uint32_t flags = 0;          // ID of the ray flags
    std::uint32_t structure = 0;      // ID of the loaded acceleration structure
    bool structureIndexed = false;    // it is an element of an array, chosen at run time
    bool structureElsewhere = false;  // it is loaded in another block
};

struct FlowBlock {
    std::vector<QueryEvent> events;
    std::vector<std::size_t> successors;  // indices of blocks
    bool exits = false;                   // returns, or ends the invocation
};

struct FlowFunction {
    std::vector<QueryObject> objects;
    std::vector<FlowBlock> blocks;  // the first is the entry
};

struct FlowModule {
    std::vector<FlowFunction> functions;                         // only those with ray queries
    std::unordered_map<std::uint32_t, std::uint32_t> constants;  // IDs and first words of scalar constants
    // Returns null if `id` is no scalar constant. For a specialisation constant it returns the default.
    const std::uint32_t* findConstant(std::uint32_t id) const;
};

// Requires a valid module from prepareForLint().
FlowModule readFlow(std::span<const std::uint32_t> words);

// Names an event by its place.
struct EventPlace {
    std::size_t block = 0;
    std::size_t event = 0;
    bool operator==(const EventPlace&) const = default;
    // Sorts in the order of the module.
    bool operator<(const EventPlace& other) const {
        return std::pair(block, event) < std::pair(other.block, other.event);
    }
};

inline const QueryEvent& at(const FlowFunction& function, EventPlace place) {
    return function.blocks[place.block].events[place.event];
}

// Returns the events that can happen to the object initialised at `start`, until it is initialised again or
// the function ends. They are in the order of the module.
std::vector<EventPlace> eventsAfter(const FlowFunction& function, EventPlace start);
// Returns whether a path from `start` reaches the end of the function, or initialises the object again,
// without passing `via`.
bool canAvoid(const FlowFunction& function, EventPlace start, EventPlace via);
// Returns whether `event` can happen again before its object is initialised again.
bool repeats(const FlowFunction& function, EventPlace event);

// --- Prepares a module: checks, inlines and folds it, and finds the place of its instructions ---

// Returns the error "spirv-invalid" with the validator's first message. It accepts any version of SPIR-V that
// the validator knows.
Status checkSpirv(std::span<const std::uint32_t> words);

// Returns a copy in which everything that a driver inlines and folds is inlined and folded: functions with
// ray queries, and small ones. Before each ray query instruction stands an OpLine whose line is the offset of
// the original instruction in `words`. Requires a valid module.
std::vector<std::uint32_t> prepareForLint(std::span<const std::uint32_t> words);

bool isRayQueryInstruction(std::uint32_t opcode);
bool isTraceInstruction(std::uint32_t opcode);

struct SpirvEntryPoint {
    std::uint32_t model = 0;
    std::uint32_t function = 0;
    std::string name;
};

// Requires a valid module.
std::vector<SpirvEntryPoint> findEntryPoints(std::span<const std::uint32_t> words);

// Returns the places of all ray queries and traces, by offset. Requires a valid module.
std::map<std::size_t, SpirvPlace> findPlaces(std::span<const std::uint32_t> words);

}  // namespace glint::compiler
