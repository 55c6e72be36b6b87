# SPDX-License-Identifier: MIT
# Run at every build: writes OUTPUT, a header with the revision of SOURCE, where it changed.
execute_process(
    COMMAND git -C ${SOURCE} rev-parse --short=12 HEAD
    OUTPUT_VARIABLE revision OUTPUT_STRIP_TRAILING_WHITESPACE
    ERROR_QUIET RESULT_VARIABLE failed)
if(failed)
    set(revision "unknown") # a source archive has no history
endif()
execute_process(
    COMMAND git -C ${SOURCE} status --porcelain --untracked-files=no
    OUTPUT_VARIABLE changes ERROR_QUIET)
if(changes STREQUAL "")
    set(dirty 0)
else()
    set(dirty 1)
endif()
file(CONFIGURE OUTPUT ${OUTPUT} CONTENT
"#define SHUTTER_REVISION \"${revision}\"
#define SHUTTER_REVISION_DIRTY ${dirty}
")
