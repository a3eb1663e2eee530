// The one place where volk's function pointers are defined: Vulkan is loaded at run time.
#define VOLK_IMPLEMENTATION
#include <volk.h>
