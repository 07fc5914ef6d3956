# Files that the Python package has beside its sources: the library and the program, without versions in their names, as
# pyproject.toml installs them. The C++ library is inside, so that the libraries of other packages do not matter.
set_property(TARGET isoweave_c PROPERTY VERSION)
set_property(TARGET isoweave_c PROPERTY SOVERSION)
target_link_options(isoweave_c PRIVATE -static-libstdc++ -static-libgcc -s)
target_link_options(isoweave_cli PRIVATE -static-libstdc++ -static-libgcc -s)
install(TARGETS isoweave_c LIBRARY DESTINATION isoweave COMPONENT python)
install(TARGETS isoweave_cli RUNTIME DESTINATION isoweave/bin COMPONENT python)
