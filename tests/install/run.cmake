# run(COMMAND…): stores the command's output in `output`; a failure ends the test.
macro(run)
  execute_process(COMMAND ${ARGV} RESULT_VARIABLE result OUTPUT_VARIABLE output ERROR_VARIABLE output)
  if(NOT result EQUAL 0)
    list(JOIN ARGV " " command)
    message(FATAL_ERROR "${command}\n${output}")
  endif()
endmacro()

# Waits until the clock of the file system has moved on, so that a file that is written next is newer than all others.
# Ninja and Make take a file of the same time for older, and the clock ticks every 1 to 10 ms.
function(wait_for_tick folder)
  set(probe "${folder}/tick")
  file(TOUCH "${probe}")
  file(TIMESTAMP "${probe}" first "%s.%f")
  set(now "${first}")
  while(now STREQUAL first)
    file(TOUCH "${probe}")
    file(TIMESTAMP "${probe}" now "%s.%f")
  endwhile()
  file(REMOVE "${probe}")
endfunction()
