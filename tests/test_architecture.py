"""The structure of docs/develop/architecture.md: dependencies point down, and no file is too
large."""

import ast
import re
import subprocess
import sys
from collections import Counter
from pathlib import Path

import pytest
from helpers.paths import ROOT

CPP = ROOT / "cpp" / "snowshed"
#: Folders whose sources belong to the namespace of the folder above.
PARTS_OF_ROOMS = ("kernels", "readers")

#: What each C++ folder may include besides itself.
ALLOWED = {
    "core": set(),
    "io": {"core"},
    "gpu": {"core", "io"},
    "particles": {"core"},
    "geometry": {"core", "particles", "io"},
    "material": {"core"},
    "sampling": {"core", "particles", "geometry"},
    "methods": {"core", "io", "gpu", "particles", "geometry", "material", "sampling"},
    "scene": {"core", "io", "particles", "geometry", "material", "sampling", "methods"},
    "run": {"core", "io", "particles", "geometry", "material", "sampling", "methods", "scene"},
}
MAX_LINES = 450
MAX_ROOMS = 12


def tracked(*patterns):
    """Return the files of the project that git tracks or could add."""
    command = ["git", "ls-files", "--cached", "--others", "--exclude-standard", *patterns]
    listed = subprocess.run(command, cwd=ROOT, capture_output=True, text=True, check=True)
    return [path for name in listed.stdout.splitlines() if (path := ROOT / name).is_file()]


def includes(source):
    """Return the headers of the library that a C++ file includes, from cpp/."""
    return re.findall(r'^#include "(snowshed/[^"]+)"', source.read_text(), re.MULTILINE)


def test_every_folder_of_the_library_has_a_rule():
    assert {path.name for path in CPP.iterdir() if path.is_dir()} == ALLOWED.keys()


@pytest.mark.parametrize("folder", ALLOWED)
def test_no_cpp_include_points_up(folder):
    wrong = [
        f"{source.relative_to(ROOT)} includes {header}"
        for source in sorted((CPP / folder).rglob("*.?pp"))
        for header in includes(source)
        if header.split("/")[1] not in ALLOWED[folder] | {folder}
    ]
    assert wrong == []


def test_no_method_includes_another():
    wrong = [
        f"{source.relative_to(ROOT)} includes {header}"
        for method in (CPP / "methods").iterdir()
        if method.is_dir()
        for source in sorted(method.rglob("*.?pp"))
        for header in includes(source)
        if header.startswith("snowshed/methods/")
        and len(Path(header).parts) > 3
        and Path(header).parts[2] != method.name
    ]
    assert wrong == []


def method_names():
    """Return the methods that the registry lists, one per line."""
    registry = (CPP / "methods" / "registry.cpp").read_text()
    return re.findall(r"^ +add\((\w+)\)", registry, re.MULTILINE)


def namespace_of(source):
    """Return the namespace of a source of the library: the folders below it; core has none."""
    folders = [part for part in source.relative_to(CPP).parent.parts if part not in PARTS_OF_ROOMS]
    return "::".join(["snowshed", *(folder for folder in folders if folder != "core")])


def test_a_namespace_has_the_name_of_its_folder():
    misplaced = []
    for source in sorted([*CPP.rglob("*.hpp"), *CPP.rglob("*.cpp")]):
        text = source.read_text(encoding="utf-8")
        opened = re.findall(r"^namespace (snowshed[\w:]*) \{", text, re.MULTILINE)
        modules = re.findall(r"^SNOWSHED_MODULE_VARIANT_BEGIN\((\S+)\)", text, re.MULTILINE)
        opened += [f"snowshed::{module}" for module in modules]
        if "\nSNOWSHED_VARIANT_BEGIN" in text:
            opened.append("snowshed")
        if opened and namespace_of(source) not in opened:
            misplaced.append(f"{source.relative_to(ROOT)}: {', '.join(opened)}")
    assert misplaced == []


def test_no_method_is_named_outside_its_folder():
    """Texts may mention a slide or grains; names, includes and values may not."""
    names = "|".join(method_names())
    prefixes = "|".join(name.capitalize() for name in method_names())
    value = re.compile(rf'"(?:{names})"|#include ".*/(?:{names})[/.].*"')
    identifier = re.compile(rf"\b(?:{prefixes})[A-Z]|(?<![a-zA-Z])(?:{names})(?![a-zA-Z])")
    own = {ROOT / "cpp" / "bindings" / "methods" / f"{name}.cpp" for name in method_names()}
    wrong = []
    for source in tracked("cpp/snowshed/*.?pp", "cpp/apps/*.?pp", "cpp/bindings/*.?pp"):
        inside = source.is_relative_to(CPP / "methods") and source.parent != CPP / "methods"
        if inside or source in own or source.name == "registry.cpp":
            continue
        code = re.sub(r"//.*", "", source.read_text())
        occurrences = value.findall(code) + identifier.findall(re.sub(r'"[^"\n]*"', "", code))
        wrong += [f"{source.relative_to(ROOT)}: {name}" for name in occurrences]
    assert len(method_names()) == 4
    assert wrong == []


def test_cpp_includes_have_no_cycles():
    graph = {f"snowshed/{path.relative_to(CPP)}": includes(path) for path in CPP.rglob("*.hpp")}
    visited = set()

    def visit(header, chain):
        assert header not in chain, " includes ".join([*chain, header])
        if header not in visited:
            for included in graph.get(header, ()):
                visit(included, [*chain, header])
            visited.add(header)

    for header in graph:
        visit(header, [])


def test_kernels_are_portable_between_compilers():
    """GCC 12 and Clang 14 know `__builtin_shufflevector`; loops are unrolled by `variant.hpp`."""
    compiler_specific = re.compile(r"__builtin_shuffle\(|#pragma (GCC|clang)")
    sources = [path for path in CPP.rglob("*.?pp") if compiler_specific.search(path.read_text())]
    assert [str(path.relative_to(ROOT)) for path in sources] == []


def test_python_imports_point_down_without_cycles():
    """The contracts are in pyproject.toml."""
    code = "from importlinter.cli import lint_imports_command; lint_imports_command()"
    command = [sys.executable, "-c", code]
    done = subprocess.run(command, cwd=ROOT, capture_output=True, text=True)
    assert done.returncode == 0, done.stdout + done.stderr


def test_modules_import_only_the_compiled_core_from_the_root():
    inside = [path for path in tracked("python/snowshed/*.py") if path.name != "__main__.py"]
    wrong = [
        f"{path.relative_to(ROOT)}: {line.strip()}"
        for path in inside
        for line in path.read_text().splitlines()
        if re.match(r"\s*from snowshed import (?!_core$)", line)
        or re.match(r"\s*import snowshed(?!\._core as _core$)", line)
    ]
    assert wrong == []


def test_the_root_of_the_package_has_few_rooms():
    package = ROOT / "python" / "snowshed"
    inside = {path.relative_to(package).parts for path in tracked("python/snowshed")}
    rooms = {parts[0] for parts in inside if len(parts) > 1}
    assert len(rooms) <= MAX_ROOMS, sorted(rooms)


def folders():
    """Return the folders of the project that contain source files, from its root."""
    inside = {path.relative_to(ROOT).parent for path in tracked("*.py", "*.?pp", "*.lua", "*.sh")}
    return {folder for path in inside for folder in (path, *path.parents)} - {Path()}


def test_the_page_lists_every_folder():
    text = (ROOT / "docs" / "develop" / "architecture.md").read_text(encoding="utf-8")
    drawing = text[text.index("```text") : text.index("## Arrows point down")]
    drawn, above = set(), []
    for indent, name in re.findall(r"^( *)([\w/]+)/", drawing, re.MULTILINE):
        above[len(indent) // 2 :] = [name]
        drawn.update({Path(*above), *Path(*above).parents})
    repeating = {"tests", "lua_compat"}  # folders that repeat others
    missing = {folder for folder in folders() - drawn if not repeating & set(folder.parts[:-1])}
    assert missing == set()
    assert {folder for folder in drawn if not (ROOT / folder).is_dir()} == set()


def test_no_source_file_is_long():
    patterns = [f"*.{ending}" for ending in ("py", "hpp", "cpp", "lua", "sh", "cmake")]
    lengths = {path: len(path.read_text().splitlines()) for path in tracked(*patterns)}
    assert {str(path): n for path, n in lengths.items() if n > MAX_LINES} == {}


#: Calls that write a file under its final name before it is complete.
WRITERS = {"write_text", "write_bytes", "savefig", "savez", "savez_compressed", "savetxt", "to_csv"}
WRITERS |= {"to_parquet", "to_netcdf", "copyfile", "copytree"}
#: Modules that may call them elsewhere, and the reasons.
WRITE_BY_NAME = {
    "io/csv_table.py": "makes texts only",
    "scene/builders/terrain.py": "has a temporary folder",
    "study/formats.py": "is given the file beside",
}


def own_names(tree):
    """Return the names in a module that come from `replacing` or stand for files in memory."""
    names = set()
    for node in ast.walk(tree):
        if isinstance(node, ast.With) and "replacing" in ast.dump(node.items[0].context_expr):
            names |= {item.optional_vars.id for item in node.items}
        if isinstance(node, ast.Assign) and "BytesIO" in ast.dump(node.value):
            names |= {target.id for target in node.targets}
    return names


def writes_by_name(tree):
    """Yield the calls that write files, except those to files of `replacing` or in memory."""
    own = own_names(tree)
    for node in ast.walk(tree):
        if not isinstance(node, ast.Call) or not isinstance(node.func, ast.Attribute):
            continue
        names = {inner.id for inner in ast.walk(node) if isinstance(inner, ast.Name)}
        texts = [inner.value for inner in ast.walk(node) if isinstance(inner, ast.Constant)]
        name = node.func.attr
        opens = name == "open" and any(re.fullmatch("[wax]b?", str(text)) for text in texts)
        saves = name == "save" and "np" in names
        if (name in WRITERS or opens or saves) and not names & own:
            yield f"line {node.lineno}: {name}"


def test_files_are_written_by_the_atomic_writer():
    package = ROOT / "python" / "snowshed"
    wrong = []
    for source in tracked("python/snowshed/**/*.py"):
        name = source.relative_to(package).as_posix()
        if name not in WRITE_BY_NAME:
            calls = writes_by_name(ast.parse(source.read_text(encoding="utf-8")))
            wrong += [f"{name}, {call}" for call in calls]
    assert wrong == []


def test_tables_pass_the_sanitizer():
    folders = ("python", "validation", "reproductions")
    wrong = [
        str(source.relative_to(ROOT))
        for source in tracked(*(f"{folder}/**/*.py" for folder in folders))
        if ".to_csv(" in source.read_text(encoding="utf-8") and source.name != "csv_table.py"
    ]
    assert wrong == []


def test_commands_print_through_the_terminal_module():
    """`say` and the consoles of cli/output/terminal.py show texts of files: notes and names."""
    wrong = [
        str(source.relative_to(ROOT))
        for source in tracked("python/snowshed/cli/**/*.py")
        if "click.echo(" in source.read_text(encoding="utf-8").replace("echo(context.get_help", "")
        and source.name != "terminal.py"
    ]
    assert wrong == []


#: Class names that two modules of the package share, and why.
SHARED_CLASS_NAMES = {
    "Simulation": "the package's simulation holds that of the core",
}


def classes(path):
    """Return the names of the classes in a Python file or stub."""
    tree = ast.parse(path.read_text(encoding="utf-8"))
    return [node.name for node in ast.walk(tree) if isinstance(node, ast.ClassDef)]


def test_a_class_name_is_unique_in_the_package():
    sources = [*tracked("python/snowshed/**/*.py"), ROOT / "cpp" / "bindings" / "_core.pyi"]
    counts = Counter(name for source in sources for name in classes(source))
    assert {name for name, count in counts.items() if count > 1} == SHARED_CLASS_NAMES.keys()
