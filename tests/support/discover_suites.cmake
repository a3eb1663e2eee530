# Writes a CTest test for each suite of a GoogleTest program, whose cases so share a process: the start of a device, of
# the validation layers and of the compiler, and what the suite keeps.
#
# PROGRAM is the program, FILE the file of tests to write, PROPERTIES what each test gets.
execute_process(COMMAND "${PROGRAM}" --gtest_list_tests OUTPUT_VARIABLE list RESULT_VARIABLE result)
if(NOT result EQUAL 0)
  message(FATAL_ERROR "${PROGRAM} does not list its cases (${result}):\n${list}")
endif()

# Suites are the lines that are not indented. What follows a # tells the type of a typed suite.
string(REGEX MATCHALL "\n[^ \n]+[.]" suites "\n${list}")
set(script "")
foreach(suite IN LISTS suites)
  string(REGEX REPLACE "^\n(.*)[.]$" "\\1" suite "${suite}")
  string(APPEND script "add_test([==[${suite}]==] [==[${PROGRAM}]==] [==[--gtest_filter=${suite}.*]==])\n"
                       "set_tests_properties([==[${suite}]==] PROPERTIES")
  foreach(property IN LISTS PROPERTIES)
    string(APPEND script " [==[${property}]==]")
  endforeach()
  string(APPEND script ")\n")
endforeach()
if(script STREQUAL "")
  message(FATAL_ERROR "${PROGRAM} has no cases")
endif()
file(WRITE "${FILE}" "${script}")
