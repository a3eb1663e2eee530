# Fails if the runtime, LIBRARY, or a PROGRAM linked to it alone contains something of the compiler, or is
# linked to the Vulkan loader, which the runtime opens at run time.
set(foreign "glslang|spvtools|spirv-tools|SPIRV-Tools|spvOptimizer|tinygltf|_ZN3fmt|libfmt|libvulkan")

execute_process(COMMAND "${NM}" "${LIBRARY}" OUTPUT_VARIABLE symbols ERROR_QUIET RESULT_VARIABLE status)
if(NOT status EQUAL 0 OR NOT symbols MATCHES "glint")
  message(FATAL_ERROR "${NM} reads no symbols from ${LIBRARY}")
endif()
string(REGEX MATCHALL "[^\n]*(${foreign})[^\n]*" found "${symbols}")
if(found)
  message(FATAL_ERROR "${LIBRARY} has symbols of the compiler: ${found}")
endif()
# No symbol, undefined or defined, may be a Vulkan command, because those are in tables.
string(REGEX MATCHALL "[^\n]* vk[A-Z][A-Za-z0-9]*\n" found "${symbols}")
if(found)
  message(FATAL_ERROR "${LIBRARY} has Vulkan commands as symbols: ${found}")
endif()

execute_process(COMMAND "${OBJDUMP}" -p "${PROGRAM}" OUTPUT_VARIABLE headers RESULT_VARIABLE status)
if(NOT status EQUAL 0 OR NOT headers MATCHES "NEEDED")
  message(FATAL_ERROR "${OBJDUMP} reads no libraries from ${PROGRAM}")
endif()
string(REGEX MATCHALL "NEEDED[^\n]*(${foreign})[^\n]*" found "${headers}")
if(found)
  message(FATAL_ERROR "${PROGRAM} needs ${found}")
endif()

execute_process(COMMAND "${PROGRAM}" RESULT_VARIABLE status OUTPUT_VARIABLE output)
if(NOT status EQUAL 0)
  message(FATAL_ERROR "${PROGRAM} ended with ${status}: ${output}")
endif()
