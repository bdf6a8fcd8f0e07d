# dagcConfig.cmake - after find_package(dagc):
#
#   dagc_add_refiner(TARGET graph.dag [NAME name] [CATALOG catalog.dag] [OPTIONS option...])
#
# compiles graph.dag with dagc into NAME.c and NAME.h (else graph.c, graph.h), for the sources of TARGET and of what links
# it to include "graph.h"; of sub/graph.dag also as "sub/graph.h", so that graphs of one name can stand in one target. In
# a project without C it is NAME.cpp. OPTIONS are dagc's, e.g. -Werror --instrument --standalone.
# The catalog is CATALOG, or what the graph says itself (catalog "net.dag";), or the standard one. Of another than that
# its catalog.h is made, too, and its folder is searched for the headers that it names.
# Also: DAGC_EXECUTABLE (set it before, or with -D, to a dagc that runs here when this package is for another machine),
# DAGC_CATALOG (the standard one), DAGC_INCLUDE_DIR, DAGC_INTERPRETER_DIR, and the library dagc::dagc, which is the
# compiler itself.
# SPDX-License-Identifier: MIT
if(POLICY CMP0116)
  cmake_policy(SET CMP0116 NEW) # paths in depfiles
endif()

get_filename_component(DAGC_PREFIX "${CMAKE_CURRENT_LIST_DIR}/../../.." ABSOLUTE)
if(NOT DAGC_EXECUTABLE)
  set(DAGC_EXECUTABLE "${DAGC_PREFIX}/bin/dagc")
endif()
set(DAGC_CATALOG "${DAGC_PREFIX}/share/dagc/catalog.dag")
set(DAGC_INCLUDE_DIR "${DAGC_PREFIX}/include/dagc")
set(DAGC_INTERPRETER_DIR "${DAGC_PREFIX}/share/dagc/interpreter")

if(NOT TARGET dagc::dagc)
  add_library(dagc::dagc STATIC IMPORTED)
  set_target_properties(dagc::dagc PROPERTIES
    IMPORTED_LOCATION "${DAGC_PREFIX}/lib/libdagc.a"
    INTERFACE_INCLUDE_DIRECTORIES "${DAGC_INCLUDE_DIR}"
    INTERFACE_LINK_LIBRARIES "${CMAKE_DL_LIBS};m")
endif()

# For the sources of the target and, where they are built here, for those of what links it.
function(_dagc_include target)
  foreach(folder ${ARGN})
    set_property(TARGET ${target} APPEND PROPERTY INCLUDE_DIRECTORIES "${folder}")
    set_property(TARGET ${target} APPEND PROPERTY INTERFACE_INCLUDE_DIRECTORIES "$<BUILD_INTERFACE:${folder}>")
  endforeach()
endfunction()

# catalog.h, once for a target.
function(_dagc_catalog target catalog folder)
  get_target_property(had ${target} DAGC_CATALOG_OF)
  if(had AND NOT had STREQUAL catalog)
    message(FATAL_ERROR "dagc_add_refiner: ${target} has graphs for ${had} and for ${catalog}: make two targets, or take --standalone")
  elseif(NOT had)
    set_property(TARGET ${target} PROPERTY DAGC_CATALOG_OF "${catalog}")
    get_filename_component(beside "${catalog}" DIRECTORY)
    add_custom_command(OUTPUT "${folder}/catalog.h"
      COMMAND "${DAGC_EXECUTABLE}" --emit=catalog-h --depfile "${folder}/catalog.d" -o "${folder}/catalog.h" "${catalog}"
      DEPENDS "${catalog}" "${DAGC_EXECUTABLE}" ${ARGN}
      COMMENT "dagc catalog.h" VERBATIM)
    target_sources(${target} PRIVATE "${folder}/catalog.h")
    _dagc_include(${target} "${folder}" "${beside}")
  endif()
endfunction()

function(dagc_add_refiner target graph)
  cmake_parse_arguments(arg "" "CATALOG;NAME" "OPTIONS" ${ARGN})
  if(arg_UNPARSED_ARGUMENTS)
    message(FATAL_ERROR "dagc_add_refiner: unknown: ${arg_UNPARSED_ARGUMENTS}")
  endif()
  get_filename_component(graph "${graph}" ABSOLUTE)
  get_filename_component(beside "${graph}" DIRECTORY)
  get_filename_component(name "${graph}" NAME)
  string(REGEX REPLACE "\\.[^.]*$" "" name "${name}")
  if(arg_NAME)
    set(name "${arg_NAME}")
  endif()
  set(top "${CMAKE_CURRENT_BINARY_DIR}/dagc/${target}")
  file(RELATIVE_PATH below "${CMAKE_CURRENT_SOURCE_DIR}" "${beside}")
  string(REPLACE ".." "up" below "${below}")
  set(folder "${top}")
  if(below)
    set(folder "${top}/${below}")
  endif()
  set(extension cpp)
  get_property(languages GLOBAL PROPERTY ENABLED_LANGUAGES)
  if("C" IN_LIST languages)
    set(extension c)
  endif()
  set(text "${folder}/${name}.${extension}")
  set(options ${arg_OPTIONS})
  set(sources "${graph}")
  set(catalog)
  if(arg_CATALOG)
    get_filename_component(catalog "${arg_CATALOG}" ABSOLUTE)
    list(APPEND options --catalog "${catalog}")
  else()
    file(STRINGS "${graph}" line REGEX "^[ \t]*catalog[ \t]+\"[^\"]+\"[ \t]*;" LIMIT_COUNT 1)
    if(line)
      string(REGEX REPLACE "^[^\"]*\"([^\"]+)\".*$" "\\1" catalog "${line}")
      get_filename_component(catalog "${catalog}" ABSOLUTE BASE_DIR "${beside}")
    endif()
  endif()
  set(depfile)
  if(NOT CMAKE_VERSION VERSION_LESS 3.20 OR CMAKE_GENERATOR MATCHES "Ninja")
    list(APPEND options --depfile "${text}.d")
    set(depfile DEPFILE "${text}.d") # imported files, the catalog, headers that are copied
  endif()
  file(MAKE_DIRECTORY "${folder}")
  if(catalog AND NOT catalog STREQUAL DAGC_CATALOG)
    list(APPEND sources "${catalog}")
    if(NOT "--standalone" IN_LIST options)
      set(catalog_depfile)
      if(depfile)
        set(catalog_depfile DEPFILE "${top}/catalog.d")
      endif()
      _dagc_catalog(${target} "${catalog}" "${top}" ${catalog_depfile})
    endif()
  endif()
  add_custom_command(OUTPUT "${text}" "${folder}/${name}.h"
    COMMAND "${DAGC_EXECUTABLE}" ${options} -o "${text}" --header "${folder}/${name}.h" "${graph}"
    DEPENDS ${sources} "${DAGC_EXECUTABLE}" ${depfile}
    COMMENT "dagc ${name}.dag" VERBATIM)
  target_sources(${target} PRIVATE "${text}" "${folder}/${name}.h")
  # No contraction of a*b+c: all releases of an oracle agree to the bit. Nobody asks for errno after a root, or for flags.
  set_source_files_properties("${text}" PROPERTIES
    COMPILE_OPTIONS "-ffp-contract=off;-fno-math-errno;-fno-trapping-math")
  _dagc_include(${target} "${top}" "${folder}" "${DAGC_INCLUDE_DIR}")
  set_property(TARGET ${target} APPEND PROPERTY LINK_LIBRARIES m)
  set_property(TARGET ${target} APPEND PROPERTY INTERFACE_LINK_LIBRARIES m)
endfunction()
