"""A method is a folder and a name in the registry; the rest of the package names none."""

import ast
import re
from pathlib import Path

import pytest
from conftest import tiny_mps, tiny_scene
from helpers.grain_files import VOXEL, write_labels
from helpers.paths import ROOT

import snowshed
from snowshed import InputError, Results, Simulation
from snowshed.cli.main import main
from snowshed.methods.grains.contacts import grain_contacts
from snowshed.methods.grains.curve import loading_curve
from snowshed.methods.method import Method, imported
from snowshed.methods.mps.settings import MpsSettings
from snowshed.methods.registry import FOLDERS, METHODS
from snowshed.methods.slide.maps import slide_maps
from snowshed.plot.stack_figures import stack_figure
from snowshed.running.method_run import MethodRun
from snowshed.scene import example_slide
from snowshed.scene.builders.grains import grains_scene
from snowshed.scene.loading import LoadingStage

PACKAGE = ROOT / "python" / "snowshed"

PRESSED = LoadingStage(kind="compress", strain=2e-3, speed=0.05)

#: Modules and folders that may name a method, with the reason. Each module names at most one,
#: except those in `NAME_ALL`.
NAME_METHODS = {
    "methods/registry.py": "the registry",
    "methods/summary.py": "the number of grains was a figure with the name `grains`",
    "cli/main.py": "two commands have the names of their methods",
    "cli/": "a command may run scenes of one method, and the self-test has a check of each",
    "scene/builders/": "a builder makes scenes of one method",
    "plot/slide_figure.py": "draws maps, which only slides have",
    "plot/slide_page.py": "shows maps, which only slides have",
    "plot/loading_figure.py": "draws curves, which only loading tests have",
    "plot/force_chains.py": "draws contacts of grains",
    "results/avaframe.py": "writes the files of another program for slides",
    "snow/accuracy/": "stacks of one method were recorded",
    "analysis/": "an analysis may ask about the results of one method",
}
NAME_ALL = {"methods/registry.py", "cli/main.py"}
#: Modules in the folders of methods that import higher layers.
PLUG_INS = ("run", "simulate", "states")
#: Modules for all methods in folders that may name a method.
SERVE_ALL = {"cli/run_scene.py", "cli/output/results.py"}


def modules():
    """Yield path and syntax tree of the modules outside the folders of methods."""
    for path in sorted(PACKAGE.rglob("*.py")):
        name = path.relative_to(PACKAGE).as_posix()
        if not name.startswith(tuple(f"methods/{folder}/" for folder in FOLDERS)):
            yield name, ast.parse(path.read_text(encoding="utf-8"))


def docstrings(tree):
    """Return the nodes of docstrings, whose examples may name methods."""
    holders = (ast.Module, ast.ClassDef, ast.FunctionDef)
    bodies = [node.body for node in ast.walk(tree) if isinstance(node, holders)]
    return {body[0].value for body in bodies if body and isinstance(body[0], ast.Expr)}


def named_methods(tree):
    """Return the methods that a module names, as texts or by imports from their folders."""
    examples = docstrings(tree)
    texts = [
        str(node.value)
        for node in ast.walk(tree)
        if isinstance(node, ast.Constant) and node not in examples
    ]
    texts += [str(node.module) for node in ast.walk(tree) if isinstance(node, ast.ImportFrom)]
    methods = {text for text in texts if text in METHODS}
    inside = [text.split(".")[2] for text in texts if text.startswith("snowshed.methods.")]
    return methods | {name.partition(":")[0] for name in inside} & set(FOLDERS)


def test_general_modules_name_no_method():
    wrong = {}
    for name, tree in modules():
        allowed = name in NAME_METHODS or any(
            name.startswith(folder) for folder in NAME_METHODS if folder.endswith("/")
        )
        limit = len(METHODS) if name in NAME_ALL else int(allowed and name not in SERVE_ALL)
        if len(methods := named_methods(tree)) > limit:
            wrong[name] = methods
    assert wrong == {}


def test_every_folder_of_a_method_is_in_the_registry():
    inside = {
        path.name for path in (PACKAGE / "methods").iterdir() if (path / "settings.py").exists()
    }
    assert inside == set(FOLDERS) == set(METHODS)


def test_every_method_has_a_run_class_and_its_readers():
    for method in METHODS.values():
        assert issubclass(method.run_class(), MethodRun), method.name
        for result, reader in method.results.items():
            assert callable(imported(reader)), (method.name, result)
            assert hasattr(Results, result), result
        for result, function in method.in_memory.items():
            assert callable(imported(function)), (method.name, result)
            assert hasattr(Simulation, result) and result in method.results


def is_plug_in(name):
    """Return whether a dotted name is a plug-in or a name in one."""
    return re.match(rf"snowshed\.methods\.\w+\.({'|'.join(PLUG_INS)})(\.|$)", name)


def test_no_module_imports_a_plug_in():
    """Only texts name plug-ins: the method's entry, and the stubs of packages."""
    wrong = [
        f"{path.relative_to(PACKAGE)}, line {node.lineno}"
        for path in PACKAGE.rglob("*.py")
        for node in ast.walk(ast.parse(path.read_text(encoding="utf-8")))
        if isinstance(node, (ast.Import, ast.ImportFrom))
        for alias in node.names
        if is_plug_in(f"{getattr(node, 'module', '')}.{alias.name}".strip("."))
    ]
    assert wrong == []


@pytest.fixture(scope="module")
def runs(tmp_path_factory):
    """A run of every method, by its name."""
    folder = tmp_path_factory.mktemp("runs")
    scenes = {
        "mpm": tiny_scene(**{"events.count": 1, "output.forces": True}),
        "mps": tiny_mps(**{"events": {"count": 1, "max_time": 0.05}, "output.forces": True}),
        "slide": example_slide(folder).set("events.max_time", 0.5),
        "grains": grains_scene(write_labels(folder), VOXEL, [PRESSED]),
    }
    return {
        name: snowshed.run(scene, folder / name, pictures=False) for name, scene in scenes.items()
    }


def test_results_have_only_the_attributes_of_their_method(runs):
    assert set(runs) == set(METHODS)
    all_results = {result for method in METHODS.values() for result in method.results}
    for name, results in runs.items():
        for result in all_results:
            if result in METHODS[name].results:
                assert getattr(results, result) is not None
                continue
            available = ", ".join(METHODS[name].results)
            with pytest.raises(
                InputError, match=f'method "{name}" has no {result}; it has {available}'
            ):
                getattr(results, result)
        if "stack" not in METHODS[name].results:
            with pytest.raises(InputError, match=f'method "{name}" has no events; it has summary'):
                _ = results.events


def test_results_agree_with_the_run(runs):
    stack, last = runs["mpm"].stack, runs["mpm"].events.iloc[-1]
    assert stack.height == pytest.approx(last.height_m, rel=1e-5)
    maps, summary = runs["slide"].maps, runs["slide"].summary
    assert float(maps.peak_speed.max()) == pytest.approx(summary.peak_speed_m_s, rel=1e-5)
    assert maps.peak_speed.attrs["units"] == "m/s" and maps.x.attrs["units"] == "m"
    curve = runs["grains"].curve
    assert curve.top_stress_pa.iloc[-1] != 0.0 and curve.attrs["units"]["top_stress_pa"] == "Pa"
    assert runs["grains"].forces.attrs["units"]["force_x_n"] == "N"


def test_functions_of_methods_take_a_public_simulation(tmp_path):
    slide = Simulation(example_slide(tmp_path))
    slide.begin_event()
    assert slide_maps(slide).thickness.max() > 0.0
    test = Simulation(grains_scene(write_labels(tmp_path), VOXEL, [PRESSED]))
    test.begin_event()
    assert len(loading_curve(test)) == 1 and len(grain_contacts(test).grains) == 2
    stack = Simulation(tiny_scene())
    stack.run()
    title = stack_figure(stack, stack.measure(), stack.scene.data).get_suptitle()
    assert title.startswith("Stack after event 1")


def test_ageing_is_refused_before_writing_if_the_method_lacks_it(tmp_path):
    ageing = imported("snowshed.running:Ageing")(settling="vionnet-2012")
    for name in set(METHODS) - {"mpm"}:
        assert not METHODS[name].ages
    with pytest.raises(InputError, match='the method "mps" does not age'):
        snowshed.run(tiny_mps(), tmp_path / "out", ageing=ageing)
    assert not (tmp_path / "out").exists()


class BlockRun(MethodRun):
    """A run of the stand-in, which writes the largest x of its particles."""

    UNIT = "blocks"

    def finish(self):
        """Write the largest x of the particles."""
        reach = self.simulation.positions()[:, 0].max()
        (self.folder / "block.txt").write_text(f"{reach:.6f}")


def read_reach(folder: Path) -> float:
    """Read what `BlockRun` wrote."""
    return float((folder / "block.txt").read_text())


def test_a_registry_entry_and_a_run_class_add_a_method(tmp_path, monkeypatch, capsys):
    """A stand-in for a method needs a registry entry and a run class."""
    entry = Method(
        name="mps",
        title="A block",
        settings=MpsSettings,
        run=f"{__name__}:BlockRun",
        results={"reach": f"{__name__}:read_reach"},
    )
    monkeypatch.setitem(METHODS, "mps", entry)
    scene = tiny_mps(**{"events": {"count": 2, "max_time": 0.05}})
    reports = []
    results = snowshed.run(scene, tmp_path / "out", progress=reports.append)
    assert reports[-1].description.startswith("2/2 blocks")
    assert results.result("reach") > 0.1
    assert [row["event"] for row in BlockRun.rows(tmp_path / "out")] == [1, 2]
    with pytest.raises(InputError, match='method "mps" has no maps; it has reach'):
        _ = results.maps
    assert main(["run", str(tmp_path / "out/scene.json"), "-o", str(tmp_path / "two")]) == 0
    assert read_reach(tmp_path / "two") == results.result("reach")
    assert str(tmp_path / "two") in capsys.readouterr().out
