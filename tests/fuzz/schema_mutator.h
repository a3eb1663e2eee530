// Mutations of JSON that follow its schema. Blind changes of bytes rarely give a member that the readers
// know.
#pragma once

#include "base/json.h"

#include <string>
#include <vector>

namespace glint::fuzz {

struct InputSchema {
    base::Json schema;
    std::vector<std::string> words;  // texts that mean something to the reader
};

// The target defines it.
const InputSchema& inputSchema();

}  // namespace glint::fuzz
