# SPDX-License-Identifier: Apache-2.0
execute_process(COMMAND ${PROGRAM} config dump --markdown
                OUTPUT_VARIABLE said RESULT_VARIABLE result)
if(NOT result EQUAL 0)
  message(FATAL_ERROR "`nadir config dump --markdown` failed: ${result}")
endif()
file(READ ${DOCUMENT} written)
if(NOT said STREQUAL written)
  message(FATAL_ERROR "${DOCUMENT} is not what `nadir config dump --markdown` prints; "
                      "run `make docs` and look at the difference")
endif()
