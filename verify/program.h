// A shader's function as a list of operations on scalars, without loops and branches. Symbolic execution
// makes it from the SPIR-V (symbolic.h). Intervals (evaluate.h) and floats (concrete.h) are evaluated along
// the list.
#pragma once

#include "verify/interval.h"

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace glint::verify {

using NodeId = std::uint32_t;
inline constexpr NodeId kNoNode = 0xFFFFFFFFU;

enum class Op : std::uint8_t {
    Constant,
    Input,
    // Operations on floats.
    Add,
    Subtract,
    Multiply,
    Square,
    Divide,
    Negate,
    Absolute,
    Sign,
    Floor,
    Ceil,
    Trunc,
    RoundEven,
    Apply,
    Power,
    ArcTangent,  // atan(a, b)
    Minimum,
    Maximum,
    Mix,         // a (1 - c) + b c
    Lerp,        // a + (b - a) c
    Normalized,  // a / √(a² + b), where c = fl(a² + b)
    Convert,     // to another float format
    // Parts of error-free transformations: Veltkamp's split, Dekker's product and Knuth's sum
    // (shaders/bsdf/exact.glsl). As single operations they have the bounds of their theorems.
    SplitHigh,
    SplitLow,
    ProductError,
    SumError,
    // Bounds of sums as a whole.
    CircleSum,     // c = (a cos t)² + (b sin t)², which lies between a² and b²
    SquareOfRoot,  // b = √(a)², which is a but for rounding
    Bounded,       // a, where |a| <= √b: a dot product and the product of the squared lengths
    UnitSum,       // a, the sum of squares of a normalised vector, which is 1; b is its squared length before
    PartOfUnit,    // a, the sum of some of these squares, which is at most 1
    WeightedUnit,  // a, the sum of squares of such components times weights; between b and c, the least and
                   // the greatest weight squared
    Share,         // a, which is b / (b + c)
    MirroredSum,   // a, the squared length of 2 (v·h) h - v; b is that of v, c that of h
    TriangleSum,   // a, the sum of squares of (x + y), which is at most b: (|x| + |y|)²
    UnitQuotient,  // a = x / max(√c, `value`), a component of a normalised vector: c = x² + b
    SphereSum,     // b = (a s cos t)² + (a s sin t)² + (a z)², where s² = (1 - z)(1 + z): it is a²
    // Comparisons, which give truth values.
    Less,
    LessEqual,
    Equal,
    // Operations on truth values.
    And,
    Or,
    Not,
    // Operations on values of any format.
    Select,  // a ? b : c
    Merge,   // the value of the edge whose guard is true; edges are in Program::edges
    Refine,  // a, where it is known that `a relation b` holds
    // Operations on integers.
    IntegerAdd,
    IntegerSubtract,
    IntegerMultiply,
    IntegerDivide,
    IntegerRemainder,
    BitAnd,
    BitOr,
    BitXor,
    BitNot,
    ShiftLeft,
    ShiftRight,
    BitReverse,
    ToInteger,    // of a float
    FromInteger,  // to a float
    BitsOf,       // a float's bits as an integer
    OfBits,
    ChangeSign,  // between int and uint, bits unchanged
};

// Whether the operation is one of the bounds of sums as a whole.
constexpr bool isBound(Op op) {
    return op >= Op::CircleSum && op <= Op::SphereSum;
}
// Returns which operand such an operation bounds: 0 for a, to 2 for c.
constexpr std::size_t boundedOperand(Op op) {
    return op == Op::CircleSum ? 2 : op == Op::SquareOfRoot || op == Op::SphereSum ? 1 : 0;
}

enum class Relation : std::uint8_t { Less, LessEqual, Greater, GreaterEqual, Equal, NotEqual };

struct Node {
    Op op = Op::Constant;
    Format format = Format::Single;
    Function function = Function::Sqrt;  // of Apply
    Relation relation = Relation::Less;  // of Refine
    bool isSigned = false;               // of integers
    bool isAuxiliary = false;            // the shader does not have it; its failures do not matter
    NodeId a = kNoNode;
    NodeId b = kNoNode;
    NodeId c = kNoNode;
    // The operation takes place where this truth value is true. kNoNode: always.
    NodeId guard = kNoNode;
    // The value of a Constant, the number of an Input, or the length below which UnitQuotient, UnitSum and
    // PartOfUnit divide vectors by it instead.
    double value = 0.0;
    std::uint32_t first = 0;  // of Merge: its edges
    std::uint32_t count = 0;
};

// Whether the operation is the square of its first operand, but for rounding.
constexpr bool isRoundedSquare(const Node& node) {
    return node.op == Op::SphereSum || (node.op == Op::CircleSum && node.a == node.b);
}

struct Edge {
    NodeId guard = kNoNode;
    NodeId value = kNoNode;
};

struct Program {
    std::vector<Node> nodes;  // each after its operands
    std::vector<Edge> edges;
    std::vector<NodeId> outputs;
    std::uint32_t inputCount = 0;
};

// Returns the operation with its operands to a depth, for messages: "x[3] / (1 - x[0])".
std::string describe(const Program& program, NodeId node, int depth = 3);
const char* nameOf(Op op);

}  // namespace glint::verify
