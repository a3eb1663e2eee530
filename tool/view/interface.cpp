#include "view/interface.h"

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>
#include <algorithm>
#include <backends/imgui_impl_glfw.h>
#include <backends/imgui_impl_vulkan.h>
#include <imgui.h>

namespace glint::view {

namespace {

void setLook(float scale) {
    ImGui::StyleColorsDark();
    ImGuiStyle& style = ImGui::GetStyle();
    style.WindowRounding = 0.0F;
    style.FrameRounding = 3.0F;
    style.GrabRounding = 3.0F;
    style.TabRounding = 3.0F;
    style.WindowBorderSize = 0.0F;
    style.FramePadding = {6.0F, 3.0F};
    style.ItemSpacing = {8.0F, 5.0F};
    style.ScrollbarSize = 12.0F;
    ImVec4* const colors = style.Colors;
    const ImVec4 accent{0.20F, 0.45F, 0.70F, 1.0F};
    colors[ImGuiCol_WindowBg] = {0.13F, 0.13F, 0.14F, 1.0F};
    colors[ImGuiCol_PopupBg] = {0.16F, 0.16F, 0.17F, 0.98F};
    colors[ImGuiCol_FrameBg] = {0.21F, 0.21F, 0.23F, 1.0F};
    colors[ImGuiCol_FrameBgHovered] = {0.27F, 0.27F, 0.30F, 1.0F};
    colors[ImGuiCol_Header] = {0.20F, 0.26F, 0.32F, 1.0F};
    colors[ImGuiCol_HeaderHovered] = {0.24F, 0.33F, 0.42F, 1.0F};
    colors[ImGuiCol_HeaderActive] = accent;
    colors[ImGuiCol_Button] = {0.24F, 0.28F, 0.33F, 1.0F};
    colors[ImGuiCol_ButtonHovered] = {0.27F, 0.38F, 0.49F, 1.0F};
    colors[ImGuiCol_ButtonActive] = accent;
    colors[ImGuiCol_Tab] = {0.18F, 0.20F, 0.23F, 1.0F};
    colors[ImGuiCol_TabHovered] = {0.27F, 0.38F, 0.49F, 1.0F};
    colors[ImGuiCol_TabActive] = accent;
    colors[ImGuiCol_CheckMark] = {0.45F, 0.72F, 1.0F, 1.0F};
    colors[ImGuiCol_SliderGrab] = {0.25F, 0.44F, 0.64F, 1.0F};
    colors[ImGuiCol_SliderGrabActive] = {0.30F, 0.54F, 0.80F, 1.0F};
    style.ScaleAllSizes(scale);
    ImGui::GetIO().FontGlobalScale = scale;
}

}  // namespace

Result<std::unique_ptr<Interface>> Interface::create(Context& context, GLFWwindow* window,
                                                     const Presenter& presenter) {
    std::unique_ptr<Interface> made(new Interface(context));
    GLINT_TRY_DO(made->start(window, presenter));
    return made;
}

Status Interface::start(GLFWwindow* window, const Presenter& presenter) {
    const DeviceHandles& handles = context_.handles();
    ImGui::CreateContext();
    ImGui::GetIO().IniFilename = nullptr;  // leaves no file where it runs
    float scale = 1.0F;
    glfwGetWindowContentScale(window, &scale, nullptr);
    setLook(std::max(scale, 1.0F));
    ImGui_ImplGlfw_InitForVulkan(window, true);
    started_ = true;

    constexpr std::uint32_t kTextures = 16;  // more than Dear ImGui has fonts
    const VkDescriptorPoolSize size{VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER, kTextures};
    VkDescriptorPoolCreateInfo pool{};
    pool.sType = VK_STRUCTURE_TYPE_DESCRIPTOR_POOL_CREATE_INFO;
    pool.flags = VK_DESCRIPTOR_POOL_CREATE_FREE_DESCRIPTOR_SET_BIT;
    pool.maxSets = kTextures;
    pool.poolSizeCount = 1;
    pool.pPoolSizes = &size;
    VkResult result = vkCreateDescriptorPool(handles.device, &pool, nullptr, &pool_);
    if (result != VK_SUCCESS) {
        return callError("vkCreateDescriptorPool", result);
    }

    ImGui_ImplVulkan_InitInfo info{};
    info.Instance = handles.instance;
    info.PhysicalDevice = handles.physicalDevice;
    info.Device = handles.device;
    info.QueueFamily = handles.queueFamily;
    info.Queue = handles.queue;
    info.DescriptorPool = pool_;
    info.MinImageCount = Presenter::kFramesInFlight;
    // One set of vertex buffers for each frame that may be in flight, and one more to be safe from reuse.
    info.ImageCount = Presenter::kFramesInFlight + 1;
    info.MSAASamples = VK_SAMPLE_COUNT_1_BIT;
#if IMGUI_VERSION_NUM >= 19080
    info.RenderPass = presenter.renderPass();
    ImGui_ImplVulkan_Init(&info);
#else
    ImGui_ImplVulkan_Init(&info, presenter.renderPass());
#endif

#if IMGUI_VERSION_NUM < 19000
    // Older backends leave the upload of the font to the program.
    VkCommandPoolCreateInfo commandPool{};
    commandPool.sType = VK_STRUCTURE_TYPE_COMMAND_POOL_CREATE_INFO;
    commandPool.queueFamilyIndex = handles.queueFamily;
    VkCommandPool once = VK_NULL_HANDLE;
    result = vkCreateCommandPool(handles.device, &commandPool, nullptr, &once);
    if (result != VK_SUCCESS) {
        return callError("vkCreateCommandPool", result);
    }
    VkCommandBufferAllocateInfo allocation{};
    allocation.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_ALLOCATE_INFO;
    allocation.commandPool = once;
    allocation.level = VK_COMMAND_BUFFER_LEVEL_PRIMARY;
    allocation.commandBufferCount = 1;
    VkCommandBuffer commands = VK_NULL_HANDLE;
    vkAllocateCommandBuffers(handles.device, &allocation, &commands);
    VkCommandBufferBeginInfo begin{};
    begin.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO;
    begin.flags = VK_COMMAND_BUFFER_USAGE_ONE_TIME_SUBMIT_BIT;
    vkBeginCommandBuffer(commands, &begin);
    ImGui_ImplVulkan_CreateFontsTexture(commands);
    vkEndCommandBuffer(commands);
    VkSubmitInfo submit{};
    submit.sType = VK_STRUCTURE_TYPE_SUBMIT_INFO;
    submit.commandBufferCount = 1;
    submit.pCommandBuffers = &commands;
    vkQueueSubmit(handles.queue, 1, &submit, VK_NULL_HANDLE);
    vkQueueWaitIdle(handles.queue);
    ImGui_ImplVulkan_DestroyFontUploadObjects();
    vkDestroyCommandPool(handles.device, once, nullptr);
#endif
    return okStatus();
}

Interface::~Interface() {
    VkDevice device = context_.handles().device;
    vkDeviceWaitIdle(device);
    if (pool_ != VK_NULL_HANDLE) {
        ImGui_ImplVulkan_Shutdown();
    }
    if (started_) {
        ImGui_ImplGlfw_Shutdown();
    }
    ImGui::DestroyContext();
    vkDestroyDescriptorPool(device, pool_, nullptr);
}

void Interface::begin() {
    ImGui_ImplVulkan_NewFrame();
    ImGui_ImplGlfw_NewFrame();
    ImGui::NewFrame();
}

void Interface::end() {
    ImGui::Render();
}

void Interface::record(VkCommandBuffer commands) {
    ImGui_ImplVulkan_RenderDrawData(ImGui::GetDrawData(), commands);
}

}  // namespace glint::view
