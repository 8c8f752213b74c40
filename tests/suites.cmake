# Run by ctest as it starts: adds a ctest entry for each test suite of `program`. A suite is one process, so that devices,
# contexts, programs and kernels are made once: a process a test takes 1.5 to 5 times as long. Even a kernel that PoCL has in
# its cache costs each process a tenth of a second. Skipped tests give their reason in Testing/Temporary/LastTest.log.
cmake_policy(VERSION 3.22)
execute_process(COMMAND ${program} --gtest_list_tests OUTPUT_VARIABLE lines RESULT_VARIABLE status)
if(NOT status EQUAL 0)
  add_test(${folder}_tests_not_listed ${program} --gtest_list_tests)
  return()
endif()

# Further arguments: NAME=VALUE for the environment.
function(add_entry name filter)
  add_test(${name} ${program} --gtest_filter=${filter} --gtest_brief=1)
  set(lock)
  if(suite IN_LIST of_one_kernel)
    set(lock RESOURCE_LOCK ${folder}_kernel)
  endif()
  set(environment LIGHTGRID_TUNED=off)
  # .ci/run sets LIGHTGRID_CL_QUICK_BUILD=all. Read here, since this runs when ctest starts.
  if("$ENV{LIGHTGRID_CL_QUICK_BUILD}" STREQUAL all AND NOT suite IN_LIST unoptimised_suites AND
     (folder IN_LIST optimised_folders OR suite MATCHES "PassCases$"))
    list(APPEND environment LIGHTGRID_CL_QUICK_BUILD=gpu)
  endif()
  if(suite MATCHES "HardCasesOf$" AND (ARGN OR DEFINED ENV{LIGHTGRID_CL_QUICK_BUILD}))
    list(APPEND environment LIGHTGRID_TEST_CPU_SHAPE=1)  # the CPU's shape of kernels alone
  endif()
  set(labels ${folder})
  if(ARGN OR suite IN_LIST thorough_suites)
    list(APPEND labels thorough)  # left to ./lightgrid test --all
  endif()
  set_tests_properties(${name} PROPERTIES TIMEOUT 900 SKIP_RETURN_CODE 77 LABELS "${labels}" COST ${cost} ${lock}
                       ENVIRONMENT "${environment};${ARGN}")
endfunction()

# The forms of the CPU kernels that are not this machine's own, which tests without POCL_KERNELLIB_NAME hold.
set(other_forms avx2 sse2)
if(EXISTS /proc/cpuinfo)
  file(STRINGS /proc/cpuinfo flags REGEX "^flags" LIMIT_COUNT 1)
  if(flags MATCHES " avx2" AND NOT flags MATCHES " avx512f")
    set(other_forms sse2)
  endif()
endif()

string(REPLACE "\n" ";" lines "${lines}")
foreach(line IN LISTS lines)
  string(REGEX REPLACE " +#.*" "" line "${line}")
  if(line MATCHES "^([^ ]+)\\.$")
    set(suite ${CMAKE_MATCH_1})
    add_entry(${suite} "${suite}.*")
    if(suite IN_LIST of_each_form)
      # Not Drawn/HardCasesOf: Soups/RaysInSoups holds rays in each form, OpenGL's lists and caps have no code of a form, and
      # KernelForms draws groups and capped lists with each.
      foreach(form IN LISTS other_forms)
        add_entry(${form}/${suite} "${suite}.*" POCL_KERNELLIB_NAME=${form})
      endforeach()
    endif()
  endif()
endforeach()
