// Passes that show what the runtime gave them, instead of passes that shade.
#extension GL_EXT_buffer_reference : require
#extension GL_EXT_scalar_block_layout : require
#extension GL_EXT_nonuniform_qualifier : require

#include "interop/frame.h"

layout(push_constant, scalar) uniform PushBlock {
    PushConstants pushed;
};

#define FRAME pushed.frame.data
