// Fuzzes the text of a lock file.
#include "fuzz/fuzz_target.h"
#include "plan/lock.h"

#include <string>
#include <variant>

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    using glint::fuzz::require;
    const auto parsed = glint::compiler::parseLock(glint::fuzz::asText(data, size));
    if (const auto* error = std::get_if<glint::compiler::LockTextError>(&parsed)) {
        require(error->line >= 1 && !error->message.empty(), "an error of a lock has a line and a message");
        return 0;
    }
    const glint::compiler::LockedIds& ids = std::get<glint::compiler::LockText>(parsed).ids;
    for (const auto& [mask, id] : ids) {
        require(id >= 0 && id <= glint::compiler::kMaxLockedId, "locked IDs are in range");
    }
    const std::string text = glint::compiler::formatLock(ids);
    const auto again = glint::compiler::parseLock(text);
    const auto* lock = std::get_if<glint::compiler::LockText>(&again);
    require(lock != nullptr && lock->ids == ids, "a lock reads back as it was written");
    require(lock->repeated.empty(), "a lock that was written repeats no key");
    require(glint::compiler::formatLock(lock->ids) == text, "the same IDs give the same text");
    return 0;
}
