# Builds libstereopsis.a with cargo and gives the target stereopsis::stereopsis to link.
#
#   set(STEREOPSIS_METHOD block)
#   set(STEREOPSIS_WIDTH 320)
#   set(STEREOPSIS_DISPARITIES 64)
#   set(STEREOPSIS_RUST_TARGET thumbv7em-none-eabihf)
#   include(path/to/stereopsis.cmake)
#   target_link_libraries(firmware PRIVATE stereopsis::stereopsis)
#
# Who links it finds stereopsis.h, and the macros STEREOPSIS_WIDTH, STEREOPSIS_DISPARITIES and STEREOPSIS_BYTES: the
# memory of a matcher is STEREOPSIS_BYTES(STEREOPSIS_WIDTH, STEREOPSIS_DISPARITIES) bytes. That of a rectifier is
# STEREOPSIS_RECTIFIER_BYTES(STEREOPSIS_WIDTH, STEREOPSIS_HEIGHT, STEREOPSIS_LINES) bytes.
#
# A library may hold several instances, each with a prefix before its functions' names; Rust's libraries cannot be linked
# twice. Choices have commas between them, one for each prefix or one for all; the macros describe the first instance:
#
#   set(STEREOPSIS_PREFIX near_,far_)
#   set(STEREOPSIS_METHOD fast,sgm)
#   set(STEREOPSIS_WIDTH 160,320)

# A choice that the project has set stays, whatever version of CMake it asks for as its least: by the policies of versions
# before 3.21 an entry of the cache would take the variable away.
cmake_policy(PUSH)
if(POLICY CMP0126)
  cmake_policy(SET CMP0126 NEW)
endif()
macro(stereopsis_choice name value type text)
  if(POLICY CMP0126 OR NOT DEFINED ${name})
    set(${name} "${value}" CACHE ${type} "${text}")
  endif()
endmacro()
stereopsis_choice(STEREOPSIS_METHOD block STRING "How lines are matched: block, fast, sgm-lean, sgm or sgm-edge")
stereopsis_choice(STEREOPSIS_WIDTH 320 STRING "Pixels of the longest line, at least the disparities")
stereopsis_choice(STEREOPSIS_DISPARITIES 64 STRING "Disparities of the longest search, a multiple of 16")
stereopsis_choice(STEREOPSIS_HEIGHT 240 STRING "Rows of the largest rectified image, for rectifiers")
stereopsis_choice(STEREOPSIS_LINES 33 STRING "Raw lines of each camera that a rectifier holds, one of them twice")
stereopsis_choice(STEREOPSIS_PREFIX "" STRING "What the functions' names begin with: STEREOPSIS_FUNCTIONS(prefix); declares them")
stereopsis_choice(STEREOPSIS_RUST_TARGET "" STRING "Rust's name of the target; empty is this machine")
stereopsis_choice(STEREOPSIS_CPU "" STRING "Rust's name of the core where its target leaves one open, such as cortex-m33")
stereopsis_choice(STEREOPSIS_FEATURES "" STRING "Rust's names of the core's instructions where neither says them, such as +dsp")
stereopsis_choice(STEREOPSIS_DSP ON BOOL "Assembly where the core has instructions on several bytes, as a Cortex-M4 and M7 have")
stereopsis_choice(STEREOPSIS_PROFILE release STRING "Cargo's profile: release, or checked under sanitizers")
stereopsis_choice(STEREOPSIS_TARGET_DIR "${CMAKE_CURRENT_BINARY_DIR}/stereopsis-target" PATH "Cargo's folder of build products")
cmake_policy(POP)

if(CMAKE_CROSSCOMPILING AND STEREOPSIS_RUST_TARGET STREQUAL "")
  message(FATAL_ERROR "STEREOPSIS_RUST_TARGET must name Rust's target, such as thumbv7em-none-eabihf")
endif()
find_program(STEREOPSIS_CARGO cargo REQUIRED)

set(STEREOPSIS_CARGO_TARGET "")
if(NOT STEREOPSIS_RUST_TARGET STREQUAL "")
  set(STEREOPSIS_CARGO_TARGET --target ${STEREOPSIS_RUST_TARGET})
endif()
set(STEREOPSIS_FLAGS "")
if(NOT STEREOPSIS_CPU STREQUAL "")
  string(APPEND STEREOPSIS_FLAGS " -C target-cpu=${STEREOPSIS_CPU}")
endif()
if(NOT STEREOPSIS_FEATURES STREQUAL "")
  string(APPEND STEREOPSIS_FLAGS " -C target-feature=${STEREOPSIS_FEATURES}")
endif()
if(NOT STEREOPSIS_DSP)
  string(APPEND STEREOPSIS_FLAGS " --cfg stereopsis_portable")
endif()
# Without flags of its own, cargo takes those of its configuration.
set(STEREOPSIS_RUSTFLAGS "")
if(NOT STEREOPSIS_FLAGS STREQUAL "")
  set(STEREOPSIS_RUSTFLAGS "RUSTFLAGS=$ENV{RUSTFLAGS}${STEREOPSIS_FLAGS}")
endif()
set(STEREOPSIS_LIBRARY "${CMAKE_CURRENT_BINARY_DIR}/libstereopsis.a")

# Cargo knows best what has changed, so it is always asked. Its folder may be shared by several configurations; the copy
# is this one's own.
add_custom_target(stereopsis_library
  COMMAND ${CMAKE_COMMAND} -E env
    STEREOPSIS_METHOD=${STEREOPSIS_METHOD}
    STEREOPSIS_WIDTH=${STEREOPSIS_WIDTH}
    STEREOPSIS_DISPARITIES=${STEREOPSIS_DISPARITIES}
    STEREOPSIS_HEIGHT=${STEREOPSIS_HEIGHT}
    STEREOPSIS_LINES=${STEREOPSIS_LINES}
    STEREOPSIS_PREFIX=${STEREOPSIS_PREFIX} ${STEREOPSIS_RUSTFLAGS}
    ${STEREOPSIS_CARGO} build --locked --quiet --profile ${STEREOPSIS_PROFILE}
    --manifest-path ${CMAKE_CURRENT_LIST_DIR}/library/Cargo.toml
    --target-dir ${STEREOPSIS_TARGET_DIR} ${STEREOPSIS_CARGO_TARGET}
  COMMAND ${CMAKE_COMMAND} -E copy_if_different
    ${STEREOPSIS_TARGET_DIR}/${STEREOPSIS_RUST_TARGET}/${STEREOPSIS_PROFILE}/libstereopsis.a ${STEREOPSIS_LIBRARY}
  BYPRODUCTS ${STEREOPSIS_LIBRARY}
  COMMENT "libstereopsis.a: ${STEREOPSIS_METHOD}, ${STEREOPSIS_WIDTH} px, ${STEREOPSIS_DISPARITIES} disparities"
  VERBATIM)

foreach(choice METHOD WIDTH DISPARITIES HEIGHT LINES)
  string(REGEX REPLACE ",.*" "" STEREOPSIS_FIRST_${choice} "${STEREOPSIS_${choice}}")
endforeach()
string(TOUPPER "${STEREOPSIS_FIRST_METHOD}" STEREOPSIS_METHOD_MACRO)
string(REPLACE "-" "_" STEREOPSIS_METHOD_MACRO "${STEREOPSIS_METHOD_MACRO}")
add_library(stereopsis::stereopsis STATIC IMPORTED GLOBAL)
add_dependencies(stereopsis::stereopsis stereopsis_library)
set_target_properties(stereopsis::stereopsis PROPERTIES
  IMPORTED_LOCATION ${STEREOPSIS_LIBRARY}
  INTERFACE_INCLUDE_DIRECTORIES ${CMAKE_CURRENT_LIST_DIR}/../../src/ffi
  INTERFACE_COMPILE_DEFINITIONS
    "STEREOPSIS_WIDTH=${STEREOPSIS_FIRST_WIDTH};STEREOPSIS_HEIGHT=${STEREOPSIS_FIRST_HEIGHT};STEREOPSIS_LINES=${STEREOPSIS_FIRST_LINES};STEREOPSIS_DISPARITIES=${STEREOPSIS_FIRST_DISPARITIES};STEREOPSIS_BYTES=STEREOPSIS_${STEREOPSIS_METHOD_MACRO}_BYTES")

if(STEREOPSIS_RUST_TARGET MATCHES "-none")
  # The library's panic handler cannot be linked: what nobody calls has to be dropped.
  set_property(TARGET stereopsis::stereopsis PROPERTY INTERFACE_LINK_OPTIONS -Wl,--gc-sections)
else()
  # What Rust's std stands on.
  find_package(Threads REQUIRED)
  set_property(TARGET stereopsis::stereopsis PROPERTY INTERFACE_LINK_LIBRARIES Threads::Threads ${CMAKE_DL_LIBS} m)
endif()
