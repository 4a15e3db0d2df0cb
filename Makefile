.DEFAULT_GOAL := help
PYTHON := .venv/bin/python
KINEFAB = $(PYTHON) -m kinefab
OUT := out
# Where `make tool` leaves dotnet-kinefab; it stands first on the recipes' PATH, before one that is installed.
TOOL := csharp/src/Kinefab.Cli/bin/Release/net10.0
export PATH := $(CURDIR)/$(TOOL):$(PATH)
SDK = dotnet --list-sdks 2>/dev/null | grep -q '^1[0-9]\.'
export DOTNET_CLI_TELEMETRY_OPTOUT := 1
export DOTNET_NOLOGO := 1

.PHONY: help extras setup tool unity demo test bench docs golden tester-kit clean

help: ## this list
	@grep -E '^[a-z-]+:.*##' $(MAKEFILE_LIST) | sed -E 's/:.*## /\t/' | expand -t 12

# Where the index has none of them, their tests are skips.
extras: setup ## libraries of single formats (STEP, IGES, FreeCAD's shapes, MuJoCo, S3), and engines to test against
	@for wanted in dev-s3,all dev-engines; do [ -f .venv/$$wanted.stamp ] || { [ -x .venv/bin/pip ] && \
		.venv/bin/pip install --quiet --disable-pip-version-check --retries 1 --timeout 15 -e "python[dev,$$wanted]" >/dev/null 2>&1 && \
		touch .venv/$$wanted.stamp; } || \
		echo "extras: $$wanted not installed, the Python index does not have them; what needs them says so" >&2; done

# A package that pip installs is compiled by pip; a checkout would be compiled by every call where Python writes no bytecode.
setup: ## .venv with everything Python needs
	@bash python/bootstrap.sh
	@$(PYTHON) -m compileall -q python/src || true

tool: ## build the command line tool, so that `dotnet kinefab` works in the recipes here
	@dotnet build csharp/src/Kinefab.Cli -c Release -v quiet --nologo

# Without the paths of this machine, so that the same sources give the same package.
unity: setup ## the package for Unity, out/com.kinefab-VERSION.tgz: Package Manager > Add package from tarball
	@dotnet build csharp/src/Kinefab -c Release -f netstandard2.1 -p:ContinuousIntegrationBuild=true -p:DebugType=none \
		-o artifacts/unity -v quiet --nologo
	@$(PYTHON) csharp/unity/pack.py artifacts/unity/Kinefab.dll -o $(OUT)

demo: setup ## the lever: CAD bundle -> Unity scene -> described, drawn, and by C# validated, moved and advised on
	@if $(SDK); then $(MAKE) --no-print-directory tool; fi
	@mkdir -p $(OUT)
	$(KINEFAB) export fixtures/lever/lever.bundle.json -o $(OUT)/lever.kinefab
	$(KINEFAB) inspect $(OUT)/lever.kinefab
	$(KINEFAB) analyse fixtures/lever/lever.bundle.json
	$(KINEFAB) draw $(OUT)/lever.kinefab -o $(OUT)/lever.svg
	@if command -v dotnet-kinefab >/dev/null; then $(MAKE) --no-print-directory demo-csharp; else \
		echo "left out: what dotnet kinefab does (validate, mobility, sweep, advise); it needs the .NET 10 SDK, https://dot.net"; fi
	@echo "The lever, to be moved by hand:"
	@$(KINEFAB) view $(OUT)/lever.kinefab -o $(OUT)/lever.html $(if $(DISPLAY)$(WAYLAND_DISPLAY),--open)

.PHONY: demo-csharp
demo-csharp:
	dotnet-kinefab validate $(OUT)/lever.kinefab
	dotnet-kinefab inspect $(OUT)/lever.kinefab
	dotnet-kinefab mobility $(OUT)/lever.kinefab
	dotnet-kinefab sweep $(OUT)/lever.kinefab --joint Lever/Crank:1 --from 0 --to 360 --steps 12 -o $(OUT)/lever.motion.json
	$(PYTHON) fixtures/lever/motion_table.py $(OUT)/lever.motion.json
	dotnet-kinefab advise $(OUT)/lever.kinefab

test: setup extras ## every test of both languages; the last line counts them
	@if $(SDK); then $(MAKE) --no-print-directory tool; fi
	@$(PYTHON) tests/run.py

bench: setup tool ## the measured figures of the README
	$(PYTHON) python/bench/export_bench.py
	$(PYTHON) python/bench/analyse_bench.py
	$(PYTHON) python/bench/batch_bench.py
	$(PYTHON) python/bench/unitypackage_bench.py
	dotnet run -c Release --project csharp/bench -- load
	dotnet run -c Release --project csharp/bench -- drive
	dotnet run -c Release --project csharp/bench -- mobility
	dotnet run -c Release --project csharp/bench -- articulation
	dotnet run -c Release --project csharp/bench -- peers

docs: ## the guides and the C# reference as pages, out/docs/index.html; a broken link is an error
	@dotnet build csharp/src/Kinefab.NUnit -c Release -v quiet --nologo
	@dotnet build csharp/src/Kinefab -c Release -v quiet --nologo
	@dotnet tool restore >/dev/null
	dotnet docfx docfx.json --warningsAsErrors
	@cp out/docs/README.html out/docs/index.html

golden: setup ## write the golden scenes of fixtures anew; read the difference before you commit it
	$(PYTHON) tests/python/golden.py

tester-kit: setup ## the files for schemas/TESTER.md: what one person with an editor looks at
	$(PYTHON) tests/tester/kit.py $(OUT)/tester-kit

clean: ## remove everything that is made
	rm -rf .venv out artifacts node_modules tests/reference/node_modules
	find csharp tests/csharp -type d \( -name bin -o -name obj \) -prune -exec rm -rf {} +
