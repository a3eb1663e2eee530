# glint_basisu(TARGET): compiles the transcoder of Basis Universal into TARGET, which then reads KTX2 textures
# and packs blocks of BC formats (--compress-textures). The sources are those that scripts/fetch_basisu.sh keeps, or those of a checkout that
# GLINT_BASISU_ROOT names. Sets GLINT_HAS_BASISU.
#
# It is compiled here and not taken from a library, so that it has the flags of each build, including those of
# sanitizers and coverage, because it reads files that others wrote.

set(GLINT_BASISU_ROOT "" CACHE PATH "Sources of Basis Universal (default: where scripts/fetch_basisu.sh keeps them)")

# Finds the folder in which scripts/fetch_basisu.sh keeps the sources.
function(_glint_basisu_root result)
  foreach(candidate IN ITEMS "${GLINT_BASISU_ROOT}" "$ENV{GLINT_BASISU_ROOT}")
    if(candidate)
      set(${result} "${candidate}" PARENT_SCOPE)
      return()
    endif()
  endforeach()
  set(caches "$ENV{XDG_CACHE_HOME}")
  if(NOT caches)
    set(caches "$ENV{HOME}/.cache")
  endif()
  set(${result} "${caches}/glint-sources/basis-universal" PARENT_SCOPE)
endfunction()

function(glint_basisu target)
  _glint_basisu_root(root)
  find_library(GLINT_ZSTD_LIBRARY zstd)
  mark_as_advanced(GLINT_ZSTD_LIBRARY)
  set(GLINT_HAS_BASISU FALSE PARENT_SCOPE)
  if(NOT EXISTS "${root}/transcoder/basisu_transcoder.cpp")
    message(STATUS "KHR_texture_basisu: left out, as ${root} has no transcoder; scripts/setup.sh fetches it")
    return()
  endif()
  file(STRINGS "${root}/transcoder/basisu_transcoder_internal.h" version REGEX "define BASISD_LIB_VERSION 20[0-9]")
  if(NOT version)
    message(STATUS "KHR_texture_basisu: left out, as ${root} is not version 2.0; scripts/setup.sh fetches it")
    return()
  endif()
  if(NOT GLINT_ZSTD_LIBRARY)
    message(STATUS "KHR_texture_basisu: left out, as there is no libzstd; scripts/setup.sh installs it")
    return()
  endif()
  message(STATUS "KHR_texture_basisu: through the transcoder in ${root}")

  add_library(glint_basisu OBJECT "${root}/transcoder/basisu_transcoder.cpp")
  target_compile_features(glint_basisu PRIVATE cxx_std_17)
  # Its assertions check its caller and the file alike, but a file must not end the process. Every build
  # optimises it, because it would otherwise take seconds for each texture.
  set(level $<IF:$<BOOL:${GLINT_SANITIZE}>,-O1,-O2>)
  target_compile_options(glint_basisu PRIVATE -w ${level} -fno-strict-aliasing)
  target_compile_definitions(glint_basisu PRIVATE NDEBUG)
  # Formats that no texture becomes are left out. XUASTC brings the packers and unpackers of BC7 and ASTC.
  foreach(format IN ITEMS ATC ETC2_EAC_A8 ETC2_EAC_RG11 FXT1 PVRTC1 PVRTC2)
    target_compile_definitions(glint_basisu PRIVATE BASISD_SUPPORT_${format}=0)
  endforeach()
  if(GLINT_SANITIZE)
    target_compile_options(glint_basisu PRIVATE -fsanitize=${GLINT_SANITIZERS} -fno-sanitize-recover=all)
  endif()
  if(GLINT_FUZZ)
    target_compile_options(glint_basisu PRIVATE -fsanitize=fuzzer-no-link)
  endif()

  # The target gets the objects, so that projects that install the target do not install a second library.
  target_sources(${target} PRIVATE $<TARGET_OBJECTS:glint_basisu>)
  target_include_directories(${target} SYSTEM PRIVATE "${root}/transcoder" "${root}/zstd")
  # The library has its bare name here, as it does in an installed target.
  target_link_libraries(${target} PRIVATE zstd)
  set(GLINT_HAS_BASISU TRUE PARENT_SCOPE)
endfunction()
