#include <glint/measure/observer.h>

#include <fmt/format.h>

#include <string>
#include <vector>

namespace glint::measure {

Status checkValidation(const Observer& observer, const Context& context) {
    const std::vector<std::string> messages = context.validationMessages();
    for (const std::string& message : messages) {
        observer.report(makeWarning("validation", "", message));
    }
    if (messages.empty()) {
        return okStatus();
    }
    return makeError("validation", "", fmt::format("the validation layers have {} messages", messages.size()),
                     "this is a defect of Glint or of the driver: please report it");
}

}  // namespace glint::measure
