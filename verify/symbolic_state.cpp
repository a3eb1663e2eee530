#include "verify/symbolic_state.h"

#include "base/lists.h"

#include <algorithm>

namespace glint::verify {
namespace {

void narrow(ProgramBuilder& builder, SymbolicState& state, NodeId value, Relation relation, NodeId bound) {
    const NodeId known = state.resolve(value);
    if (builder.isConstant(known)) {
        return;
    }
    const NodeId narrower = builder.refine(known, relation, bound);
    if (narrower != known) {
        state.refined[known] = narrower;
    }
}

void learnComparison(ProgramBuilder& builder, SymbolicState& state, const Node& comparison, bool holds) {
    const NodeId a = state.resolve(comparison.a);
    const NodeId b = state.resolve(comparison.b);
    struct Learned {
        Relation ofA;
        Relation ofB;
    };
    Learned learned{};
    switch (comparison.op) {
        case Op::Less:
            learned = holds ? Learned{Relation::Less, Relation::Greater}
                            : Learned{Relation::GreaterEqual, Relation::LessEqual};
            break;
        case Op::LessEqual:
            learned = holds ? Learned{Relation::LessEqual, Relation::GreaterEqual}
                            : Learned{Relation::Greater, Relation::Less};
            break;
        default:
            learned = holds ? Learned{Relation::Equal, Relation::Equal}
                            : Learned{Relation::NotEqual, Relation::NotEqual};
            break;
    }
    narrow(builder, state, a, learned.ofA, b);
    narrow(builder, state, b, learned.ofB, a);
}

// Returns whether `a` is "p and c" and `b` is "p and not c"; sets c.
bool areOpposite(const ProgramBuilder& builder, NodeId a, NodeId b, NodeId& condition) {
    if (a == kNoNode || b == kNoNode) {
        return false;
    }
    const Node& x = builder.node(a);
    const Node& y = builder.node(b);
    if (y.op == Op::Not && y.a == a) {
        condition = a;
        return true;
    }
    if (x.op != Op::And || y.op != Op::And) {
        return false;
    }
    for (const auto& [p, c] : {std::pair(x.a, x.b), std::pair(x.b, x.a)}) {
        for (const auto& [q, d] : {std::pair(y.a, y.b), std::pair(y.b, y.a)}) {
            if (p == q && builder.node(d).op == Op::Not && builder.node(d).a == c) {
                condition = c;
                return true;
            }
        }
    }
    return false;
}

NodeId chooseTruth(ProgramBuilder& builder, NodeId condition, NodeId a, NodeId b) {
    if (builder.isConstant(a)) {
        return builder.isConstant(a, 1.0)
                   ? builder.make(Op::Or, Format::Integer, condition, b)
                   : builder.make(Op::And, Format::Integer, builder.opposite(condition), b);
    }
    if (builder.isConstant(b)) {
        return builder.isConstant(b, 1.0)
                   ? builder.make(Op::Or, Format::Integer, builder.opposite(condition), a)
                   : builder.make(Op::And, Format::Integer, condition, a);
    }
    return builder.make(Op::Select, Format::Integer, condition, a, b);
}

bool isTruth(const ProgramBuilder& builder, NodeId id) {
    const Node& node = builder.node(id);
    switch (node.op) {
        case Op::Less:
        case Op::LessEqual:
        case Op::Equal:
        case Op::And:
        case Op::Or:
        case Op::Not:
            return true;
        case Op::Constant:
            return node.format == Format::Integer && (node.value == 0.0 || node.value == 1.0);
        default:
            return false;
    }
}

}  // namespace

void learn(ProgramBuilder& builder, SymbolicState& state, NodeId condition, bool holds) {
    const Node node = builder.node(condition);
    switch (node.op) {
        case Op::Not:
            learn(builder, state, node.a, !holds);
            return;
        case Op::And:
            if (holds) {
                learn(builder, state, node.a, true);
                learn(builder, state, node.b, true);
            }
            return;
        case Op::Or:
            if (!holds) {
                learn(builder, state, node.a, false);
                learn(builder, state, node.b, false);
            }
            return;
        case Op::Less:
        case Op::LessEqual:
        case Op::Equal:
            learnComparison(builder, state, node, holds);
            return;
        default:
            return;
    }
}

NodeId joinValues(ProgramBuilder& builder, const std::vector<SymbolicState>& states,
                  const std::vector<NodeId>& values) {
    const bool same =
        std::all_of(values.begin(), values.end(), [&](NodeId value) { return value == values.front(); });
    if (same) {
        return values.front();
    }
    if (states.size() == 2) {
        for (const std::size_t first : {std::size_t{0}, std::size_t{1}}) {
            const std::size_t second = 1 - first;
            NodeId condition = kNoNode;
            if (areOpposite(builder, states[first].guard, states[second].guard, condition)) {
                if (isTruth(builder, values[0]) && isTruth(builder, values[1])) {
                    return chooseTruth(builder, condition, values[first], values[second]);
                }
                Node select;
                select.op = Op::Select;
                select.format = builder.node(values[first]).format;
                select.isSigned = builder.node(values[first]).isSigned;
                select.a = condition;
                select.b = values[first];
                select.c = values[second];
                return builder.make(select);
            }
        }
    }
    std::vector<Edge> edges;
    for (std::size_t k = 0; k < states.size(); ++k) {
        edges.push_back({states[k].guard, values[k]});
    }
    return builder.merge(edges);
}

SymbolicState join(ProgramBuilder& builder, const std::vector<SymbolicState>& states) {
    if (states.size() == 1) {
        return states.front();
    }
    SymbolicState joined;
    // Pairs of opposite guards become the guard around them, until nothing changes.
    auto guards = base::mapped<NodeId>(states, &SymbolicState::guard);
    builder.setGuard(kNoNode);
    for (bool changed = true; changed && guards.size() > 1;) {
        changed = false;
        for (std::size_t i = 0; i < guards.size() && !changed; ++i) {
            for (std::size_t k = i + 1; k < guards.size() && !changed; ++k) {
                NodeId condition = kNoNode;
                if (areOpposite(builder, guards[i], guards[k], condition) ||
                    areOpposite(builder, guards[k], guards[i], condition)) {
                    guards[i] = builder.either(guards[i], guards[k]);
                    guards.erase(guards.begin() + static_cast<std::ptrdiff_t>(k));
                    changed = true;
                }
            }
        }
    }
    joined.guard = guards.front();
    for (std::size_t k = 1; k < guards.size(); ++k) {
        joined.guard = builder.either(joined.guard, guards[k]);
    }
    builder.setGuard(joined.guard);
    for (const auto& [value, refined] : states.front().refined) {
        const bool inAll =
            std::all_of(states.begin(), states.end(), [&, key = value, known = refined](const auto& state) {
                const auto found = state.refined.find(key);
                return found != state.refined.end() && found->second == known;
            });
        if (inAll) {
            joined.refined[value] = refined;
        }
    }
    for (const auto& [number, memory] : states.front().memories) {
        bool differs = false;
        bool known = true;
        for (const SymbolicState& state : states) {
            const auto found = state.memories.find(number);
            known = known && found != state.memories.end();
            differs = differs || (known && found->second != memory);
        }
        if (!known) {
            continue;
        }
        if (!differs) {
            joined.memories[number] = memory;
            continue;
        }
        auto merged = std::make_shared<std::vector<NodeId>>();
        for (std::size_t k = 0; k < memory->size(); ++k) {
            const auto values = base::mapped<NodeId>(states, [&, key = number](const SymbolicState& state) {
                return state.memories.at(key)->at(k);
            });
            merged->push_back(joinValues(builder, states, values));
        }
        joined.memories[number] = std::move(merged);
    }
    return joined;
}

}  // namespace glint::verify
