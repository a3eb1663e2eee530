# The allocator of programs that compile shaders. SPIRV-Tools creates and destroys millions of small objects, for which
# glibc's allocator is slow.
option(GLINT_MIMALLOC "Link programs that compile shaders with mimalloc 2, where there is one" ON)

set(glint_mimalloc "")
if(GLINT_MIMALLOC AND NOT GLINT_SANITIZE AND NOT GLINT_FUZZ)
  find_package(mimalloc QUIET)
  # 3.0 (Debian 13) is a beta version. With it 2 of 14 renders with cold caches crashed in lavapipe, because memory that a
  # thread of the driver used was given out a second time. Without it none of 14 did.
  if(mimalloc_VERSION VERSION_GREATER_EQUAL 3)
    message(STATUS "Glint is not linked with mimalloc ${mimalloc_VERSION}: it takes version 2")
  elseif(GLINT_STATIC AND TARGET mimalloc-static)
    set(glint_mimalloc mimalloc-static)
  elseif(TARGET mimalloc)
    set(glint_mimalloc mimalloc)
  endif()
endif()

# glint_allocate_fast(TARGET): links a program with the allocator.
function(glint_allocate_fast target)
  target_link_libraries(${target} PRIVATE ${glint_mimalloc})
endfunction()
