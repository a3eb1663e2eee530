# cmake -DSOURCE=… -DOUTPUT=… -P own_strategy.cmake: makes what a strategy of docs/strategies.md changes, from the page's
# own text: OUTPUT/strategies.cpp is a copy of the table with its row, OUTPUT/embedded.cpp has its shaders among Glint's.
file(READ "${SOURCE}/docs/strategies.md" page)

# printed(NAME VARIABLE): sets VARIABLE to the code below the line that begins with the name in bold.
function(printed name variable)
  string(FIND "${page}" "\n**${name}**" title)
  if(title EQUAL -1)
    message(FATAL_ERROR "docs/strategies.md does not print ${name}")
  endif()
  string(SUBSTRING "${page}" ${title} -1 rest)
  string(FIND "${rest}" "```" fence)
  string(SUBSTRING "${rest}" ${fence} -1 rest)
  string(FIND "${rest}" "\n" begin)
  math(EXPR begin "${begin} + 1")
  string(SUBSTRING "${rest}" ${begin} -1 rest)
  string(FIND "${rest}" "```" end)
  string(SUBSTRING "${rest}" 0 ${end} code)
  set(${variable} "${code}" PARENT_SCOPE)
endfunction()

printed("strategies.cpp" row)
file(READ "${SOURCE}/runtime/src/modules/strategies.cpp" table)
set(after_rows "\n};\nconstexpr std::size_t kCount")
string(FIND "${table}" "${after_rows}" place)
if(place EQUAL -1)
  message(FATAL_ERROR "the end of kRows is not found")
endif()
string(REPLACE "${after_rows}" "\n${row}};\nconstexpr std::size_t kCount" table "${table}")
file(WRITE "${OUTPUT}/strategies.cpp" "${table}")

foreach(name "split_uber/split_miss.comp" "split_uber/split_shade.comp")
  printed("${name}" text)
  file(WRITE "${OUTPUT}/shaders/strategies/${name}" "${text}")
  list(APPEND added "strategies/${name}|${OUTPUT}/shaders/strategies/${name}")
endforeach()
file(READ "${EMBEDDED}" files)
list(JOIN added "\n" added)
file(WRITE "${OUTPUT}/embedded.list" "${files}${added}\n")
execute_process(
  COMMAND "${CMAKE_COMMAND}" "-DOUTPUT=${OUTPUT}/embedded.cpp" "-DLIST=${OUTPUT}/embedded.list"
          "-DHEADER=resolve/host.h" "-DFUNCTION=glint::compiler::builtinFiles" -P
          "${SOURCE}/cmake/GlintEmbed.cmake" COMMAND_ERROR_IS_FATAL ANY)
