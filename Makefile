.DEFAULT_GOAL := help
PYTHON := .venv/bin/python
TOOL := csharp/src/Kinefab.Cli/bin/Release/net10.0
export PATH := $(CURDIR)/$(TOOL):$(PATH)
export DOTNET_CLI_TELEMETRY_OPTOUT := 1
export DOTNET_NOLOGO := 1

.PHONY: help setup tool demo test bench golden clean

help: ## this list
	@grep -E '^[a-z]+:.*##' $(MAKEFILE_LIST) | sed -E 's/:.*## /\t/' | expand -t 10

setup: ## .venv with everything Python needs
	@bash python/bootstrap.sh

tool: ## build the command line tool, so that `dotnet kinefab` works in the recipes here
	@dotnet build csharp/src/Kinefab.Cli -c Release -v quiet --nologo

demo: setup tool ## the lever: CAD bundle -> Unity scene -> validated, described, moved and advised on by C#
	@mkdir -p out
	.venv/bin/kinefab export fixtures/lever/lever.bundle.json -o out/lever.kinefab
	dotnet kinefab validate out/lever.kinefab
	dotnet kinefab inspect out/lever.kinefab
	dotnet kinefab mobility out/lever.kinefab
	dotnet kinefab sweep out/lever.kinefab --joint Lever/Crank:1 --from 0 --to 360 --steps 12 -o out/lever.motion.json
	$(PYTHON) fixtures/lever/motion_table.py out/lever.motion.json
	dotnet kinefab advise out/lever.kinefab
	.venv/bin/kinefab draw out/lever.kinefab -o out/lever.svg

test: setup ## every test of both languages; the last line counts them
	@$(PYTHON) tests/run.py

bench: setup tool ## the measured figures of the README
	$(PYTHON) python/bench/export_bench.py
	$(PYTHON) python/bench/analyse_bench.py
	dotnet run -c Release --project csharp/bench -- load
	dotnet run -c Release --project csharp/bench -- drive
	dotnet run -c Release --project csharp/bench -- mobility

golden: setup ## write the golden scenes of fixtures anew; read the difference before you commit it
	$(PYTHON) tests/python/golden.py

clean: ## remove everything that is made
	rm -rf .venv out artifacts node_modules tests/reference/node_modules
	find csharp tests/csharp -type d \( -name bin -o -name obj \) -prune -exec rm -rf {} +
