cmake_minimum_required(VERSION 3.25)
# Writes OUTPUT, a header with the commit of SOURCE; "+" marks a working tree that differs from it.
execute_process(COMMAND git -C ${SOURCE} describe --always --abbrev=40 --dirty=+ --exclude=*
                OUTPUT_VARIABLE commit OUTPUT_STRIP_TRAILING_WHITESPACE ERROR_QUIET RESULT_VARIABLE failed)
if(failed)
  set(commit unknown)  # not a git checkout, or one without commits
endif()
file(CONFIGURE OUTPUT ${OUTPUT} CONTENT "#define SCREE_COMMIT \"@commit@\"\n" @ONLY)
