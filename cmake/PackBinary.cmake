# CPack's staged tree becomes one that needs no library of the machine (bundle.py).
execute_process(COMMAND python3 -B "${CPACK_LGABENCH_SOURCE}/cmake/bundle.py" "${CPACK_TEMPORARY_INSTALL_DIRECTORY}"
                COMMAND_ERROR_IS_FATAL ANY)
