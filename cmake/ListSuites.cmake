# SPDX-License-Identifier: MIT
# cmake -DPROGRAM=file -DLABEL=label -DRESULTS=folder -DCOST=[number] -DOUTPUT=file -P ListSuites.cmake
# Writes for ctest a test for each suite of a program of GoogleTest: "<label>/<suite>". A process for
# each of its cases would open the device, load libraries and compile shaders once more for each.
execute_process(
    COMMAND ${PROGRAM} --gtest_list_tests
    OUTPUT_VARIABLE listed
    COMMAND_ERROR_IS_FATAL ANY)
# Suites begin their line and end with a dot; their cases are indented below them.
string(REGEX REPLACE "#[^\n]*" "" listed "${listed}")
string(REGEX MATCHALL "[^\n]+" lines "${listed}")
set(tests "")
set(suite "")
set(cases 0)
macro(end_suite)
    if(cases GREATER 0)
        set(cost ${cases})
        if(COST)
            set(cost ${COST})
        endif()
        string(REPLACE "/" "." file "${suite}")
        string(APPEND tests
               "add_test([[${LABEL}/${suite}]] [[${PROGRAM}]] [[--gtest_filter=${suite}.*]] --gtest_brief=1"
               " [[--gtest_output=xml:${RESULTS}/${LABEL}/${file}.xml]])\n"
               "set_tests_properties([[${LABEL}/${suite}]] PROPERTIES LABELS ${LABEL} TIMEOUT 1800"
               " COST ${cost})\n")
    endif()
endmacro()
foreach(line IN LISTS lines)
    if(line MATCHES "^([A-Za-z0-9_/]+)\\. *$")
        end_suite()
        set(suite ${CMAKE_MATCH_1})
        set(cases 0)
    elseif(line MATCHES "^  [^ ]" AND NOT line MATCHES "^  DISABLED_")
        math(EXPR cases "${cases} + 1")
    endif()
endforeach()
end_suite()
if(tests STREQUAL "")
    message(FATAL_ERROR "${PROGRAM} lists no tests")
endif()
file(WRITE ${OUTPUT} "${tests}")
