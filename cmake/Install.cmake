# `cmake --install BUILD --prefix DIR`: the program, which has its kernels in itself, scenes to begin with, the docs with the
# licence, and completion for bash. It needs nothing of the source and build folders.
include(GNUInstallDirs)
install(TARGETS wedge RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR})
install(DIRECTORY data/scenes DESTINATION ${CMAKE_INSTALL_DATADIR}/wedge)
install(FILES README.md CHANGELOG.md LICENSE DESTINATION ${CMAKE_INSTALL_DOCDIR})
install(DIRECTORY docs DESTINATION ${CMAKE_INSTALL_DOCDIR})
install(FILES host/app/completion.bash DESTINATION ${CMAKE_INSTALL_DATADIR}/bash-completion/completions RENAME wedge)
