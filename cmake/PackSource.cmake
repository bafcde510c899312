# Beside the binary archive, the sources of the commit that it was built from, with their checksum.
set(archive "${CPACK_PACKAGE_DIRECTORY}/${CPACK_LGABENCH_NAME}-source.tar.gz")
execute_process(COMMAND git archive --format=tar.gz "--prefix=${CPACK_LGABENCH_NAME}/" "--output=${archive}" HEAD
                WORKING_DIRECTORY "${CPACK_LGABENCH_SOURCE}" RESULT_VARIABLE failed ERROR_VARIABLE why)
if(failed)
  message(STATUS "no source archive, which git makes of a clone: ${why}")
else()
  file(SHA256 "${archive}" sum)
  file(WRITE "${archive}.sha256" "${sum}  ${CPACK_LGABENCH_NAME}-source.tar.gz\n")
  message(STATUS "package: ${archive} generated.")
endif()
