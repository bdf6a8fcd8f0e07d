# dagcConfig.cmake - after find_package(dagc):
#
#   dagc_add_refiner(TARGET graph.dag [CATALOG catalog.dag] [OPTIONS option...])
#
# compiles graph.dag with dagc into graph.c and graph.h, for the C sources of TARGET to include "graph.h".
# A catalog of your own needs its own catalog.h: see FILES in dagc(1).
# Also: DAGC_EXECUTABLE, DAGC_CATALOG (the standard one), DAGC_INCLUDE_DIR, and the library dagc::dagc, which is
# the compiler itself. OPTIONS are dagc's, e.g. -Werror --instrument.
# SPDX-License-Identifier: MIT
if(POLICY CMP0116)
  cmake_policy(SET CMP0116 NEW) # paths in depfiles
endif()

get_filename_component(DAGC_PREFIX "${CMAKE_CURRENT_LIST_DIR}/../../.." ABSOLUTE)
set(DAGC_EXECUTABLE "${DAGC_PREFIX}/bin/dagc")
set(DAGC_CATALOG "${DAGC_PREFIX}/share/dagc/catalog.dag")
set(DAGC_INCLUDE_DIR "${DAGC_PREFIX}/include/dagc")

if(NOT TARGET dagc::dagc)
  add_library(dagc::dagc STATIC IMPORTED)
  set_target_properties(dagc::dagc PROPERTIES
    IMPORTED_LOCATION "${DAGC_PREFIX}/lib/libdagc.a"
    INTERFACE_INCLUDE_DIRECTORIES "${DAGC_INCLUDE_DIR}"
    INTERFACE_LINK_LIBRARIES "${CMAKE_DL_LIBS};m")
endif()

function(dagc_add_refiner target graph)
  cmake_parse_arguments(arg "" "CATALOG" "OPTIONS" ${ARGN})
  if(arg_UNPARSED_ARGUMENTS)
    message(FATAL_ERROR "dagc_add_refiner: unknown: ${arg_UNPARSED_ARGUMENTS}")
  endif()
  get_filename_component(graph "${graph}" ABSOLUTE)
  get_filename_component(name "${graph}" NAME_WE)
  set(folder "${CMAKE_CURRENT_BINARY_DIR}/dagc/${target}")
  set(made "${folder}/${name}.c" "${folder}/${name}.h")
  set(options ${arg_OPTIONS})
  set(sources "${graph}")
  if(arg_CATALOG)
    get_filename_component(catalog "${arg_CATALOG}" ABSOLUTE)
    list(APPEND options --catalog "${catalog}")
    list(APPEND sources "${catalog}")
  endif()
  set(depfile)
  if(NOT CMAKE_VERSION VERSION_LESS 3.20 OR CMAKE_GENERATOR MATCHES "Ninja")
    list(APPEND options --depfile "${folder}/${name}.d")
    set(depfile DEPFILE "${folder}/${name}.d") # imported files, too
  endif()
  file(MAKE_DIRECTORY "${folder}")
  add_custom_command(OUTPUT ${made}
    COMMAND "${DAGC_EXECUTABLE}" ${options} -o "${folder}/${name}.c" --header "${folder}/${name}.h" "${graph}"
    DEPENDS ${sources} "${DAGC_EXECUTABLE}" ${depfile}
    COMMENT "dagc ${name}.dag" VERBATIM)
  target_sources(${target} PRIVATE ${made})
  # No contraction of a*b+c: all releases of an oracle agree to the bit.
  set_source_files_properties("${folder}/${name}.c" PROPERTIES COMPILE_OPTIONS "-ffp-contract=off")
  set_property(TARGET ${target} APPEND PROPERTY INCLUDE_DIRECTORIES "${folder}" "${DAGC_INCLUDE_DIR}")
  set_property(TARGET ${target} APPEND PROPERTY LINK_LIBRARIES m)
endfunction()
