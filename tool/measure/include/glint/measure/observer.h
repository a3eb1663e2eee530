// The observer to which a library reports its progress.
#pragma once

#include <glint/context.h>
#include <glint/result.h>

#include <span>
#include <string_view>

namespace glint::measure {

// The functions are const because no decision of a library depends on them. They may be called by the thread
// that called the library only.
class Observer {
public:
    virtual ~Observer() = default;

    // A warning or a note. Errors are returned.
    virtual void report(const Diagnostic& diagnostic) const = 0;
    // Receives the present activity, such as "compiling 3 of 8".
    virtual void progress(std::string_view text) const = 0;
    // Receives a decision and its reason.
    virtual void detail(std::string_view text) const = 0;

    void report(std::span<const Diagnostic> diagnostics) const {
        for (const Diagnostic& diagnostic : diagnostics) {
            report(diagnostic);
        }
    }
};

// Returns the error "validation" with the number of messages of the Vulkan validation layers, each of which
// is reported as a warning. There are none if the context has no such layers.
Status checkValidation(const Observer& observer, const Context& context);

}  // namespace glint::measure
