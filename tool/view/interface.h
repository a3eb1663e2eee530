// Dear ImGui in the window: its context, its look, and the draws of its panels.
#pragma once

#include "view/presenter.h"

#include <memory>

struct GLFWwindow;

namespace glint::view {

class Interface {
public:
    // Callbacks of the window that were set before are called by those of Dear ImGui. Everything given must
    // outlive it. Error "vulkan-call".
    static Result<std::unique_ptr<Interface>> create(Context& context, GLFWwindow* window,
                                                     const Presenter& presenter);
    ~Interface();
    Interface(const Interface&) = delete;
    Interface& operator=(const Interface&) = delete;

    // Begins the panels of a frame, between which ImGui's functions may be called.
    void begin();
    // Ends them. record() then draws them.
    void end();
    void record(VkCommandBuffer commands);

private:
    explicit Interface(Context& context) : context_(context) {}
    Status start(GLFWwindow* window, const Presenter& presenter);

    Context& context_;
    VkDescriptorPool pool_ = VK_NULL_HANDLE;
    bool started_ = false;
};

}  // namespace glint::view
