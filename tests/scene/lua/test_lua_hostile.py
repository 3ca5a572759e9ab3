"""Hostile scripts are stopped in less than a second, with line and reason."""

import errno
import os
import subprocess
import sys

import pytest
from lua_helpers import error_of, error_within, load

from snowshed.scene import LuaLimits

STOPPED = "stopped after 10000000 instructions"
MEMORY = "stopped: more than 8 MB of memory"
SOFT = "stopped after 0.25 s"
HARD = "stopped in one operation that takes more than the 0.4 s"
TIME_LIMIT = 1.0  # s of processor time
# Large enough that a slow moment of the machine does not stop a script before its own action.
LONG_LIMITS = LuaLimits(soft_seconds=3, hard_seconds=3)

# A table with gaps that claims 2^40 items; all of its keys are in the hash part.
GAPS = "{" + ",".join(f"[{2**k}]=1" for k in range(41)) + "}"

# Script, the line that the error names (0: none), and the message.
SCRIPTS = {
    "endless loop": ("\nwhile true do end", 2, STOPPED),
    "endless jump": ("::again::\ngoto again", 2, STOPPED),
    "endless for": ("for i = 1, math.huge do end", 1, STOPPED),
    "endless tail calls": ("local function f()\nreturn f() end\nf()", 2, STOPPED),
    "endless calls": ("local function f()\nreturn 1 + f() end\nf()", 2, MEMORY),
    "endless printing": ("while true do print('x') end", 1, STOPPED),
    "endless settings": ("\n\nwhile true do gravity(1) end", 3, "more than 10000 calls"),
    "endless order": ("table.sort({3, 1, 2}, function()\nwhile true do end end)", 2, STOPPED),
    "doubling text": ("local s = 'x'\nwhile true do\ns = s .. s\nend", 3, MEMORY),
    "growing table": ("local t = {}\nfor i = 1, 1e9 do t[i] = i end", 2, MEMORY),
    "many small tables": ("local t = {}\nwhile true do t = {t, {}} end", 2, MEMORY),
    "large settings": ("while true do title(('x'):rep(1e6)) end", 1, MEMORY),
    "many values": (
        "local t = {}\nwhile true do t[#t + 1] = {table.unpack({}, 1, 2e5)} end",
        2,
        MEMORY,
    ),
    "too many values": ("print(table.unpack({}, 1, 1e7))", 1, "too many results"),
    "long text": ("\nlocal s = ('x'):rep(1e10)", 2, "string.rep would make a text of 1e+10 bytes"),
    "long text of separators": ("string.rep('', 1e10, 'x')", 1, "would make a text of 1e+10"),
    "many empty texts": ("string.rep('', 1e18)\nos.exit()", 2, "os is not available"),
    "wide format": ("string.format('%99999d', 1)", 1, "invalid conversion"),
    "many copies joined": (
        "local t = {}\nfor i = 1, 2e5 do t[i] = 'xxxxxxxx' end\nwhile true do table.concat(t) end",
        3,
        SOFT,
    ),
    "join beyond the end": ("table.concat({}, '', 1, 1e15)", 1, "invalid value (nil)"),
    "insert into gaps": (f"\ntable.insert({GAPS}, 1, 1)", 2, "claims 1099511627776 items"),
    "sort gaps": (f"\ntable.sort({GAPS})", 2, "claims 1099511627776 items"),
    "move": ("table.move({}, 1, 1e18, 2)", 1, "table.move is not available"),
    "find": ("('x'):rep(99):find(('x-'):rep(50) .. 'y')", 1, "string.find is not available"),
    "match": ("string.match('x', 'x')", 1, "string.match is not available"),
    "gsub": ("string.gsub('x', 'x', print)", 1, "string.gsub is not available"),
    "gmatch": ("for a in ('x'):gmatch('.') do end", 1, "string.gmatch is not available"),
    "sort long texts": (
        "local a, b = ('x'):rep(2e6) .. 'a', ('x'):rep(2e6) .. 'b'\nlocal t = {}\n"
        "for i = 1, 1000 do t[i] = i % 2 == 0 and a or b end\ntable.sort(t)",
        0,
        HARD,
    ),
    "process": ("os.execute('true')", 1, "os is not available"),
    "exit": ("_G.os.exit(0)", 1, "os is not available"),
    "file": ("\n\nlocal f = io.open('/etc/passwd')", 3, "io is not available"),
    "change io": ("io.open = print", 1, "io is not available"),
    "module": ("require 'os'", 1, "require: there is no os.lua beside the script"),
    "loaded modules": ("local o = package.loaded.os", 1, "package is not available"),
    "text as code": ("load('while true do end')()", 1, "load is not available"),
    "bytecode": ("string.dump(print)", 1, "string.dump is not available"),
    "bytecode script": ("\x1bLua", 0, "attempt to load a binary chunk"),
    "file as code": ("dofile('init.lua')", 1, "dofile is not available"),
    "debug": ("debug.sethook()", 1, "debug is not available"),
    "debug registry": ("local r = debug.getregistry()", 1, "debug is not available"),
    "Python": ("python.eval('1')", 1, "python is not available"),
    "environment": ("setfenv(1, {})", 1, "setfenv is not available"),
    "coroutine": (
        "coroutine.wrap(function() while true do end end)()",
        1,
        "coroutine is not available",
    ),
    "pcall": ("while true do pcall(function() while true do end end) end", 1, "pcall is not"),
    "xpcall": ("xpcall(error, function() while true do end end)", 1, "xpcall is not available"),
    "text metatable": ("getmetatable('').__index = os", 1, "getmetatable is not available"),
    "finaliser": (
        "setmetatable({}, {__gc = function() while true do end end})",
        1,
        "setmetatable is not available",
    ),
    "close": ("local x <close> = {}", 1, "variable 'x' got a non-closable value"),
    "garbage": ("collectgarbage('stop')", 1, "collectgarbage is not available"),
    "error object": ("\nerror({})", 2, "error with a table instead of a message"),
    "no message": ("error()", 1, "error with a nil instead of a message"),
    "terminal": ("error('\\27[31m\\n\\255', 0)", 1, "init.lua:1:  [31m "),
    "long message": ("error(('x'):rep(1e6))", 1, "xxx..."),
    "forged location": ("error('script7:9: lie', 0)", 1, "init.lua:1: script7:9: lie"),
    "without globals": ("for k in next, _G do _G[k] = nil end", 1, "nil value"),
    "cycle": ("local t = {}\nt.t = t\nset('title', t)", 3, "nested more than 64 deep"),
    "function": ("title(print)", 1, "a function cannot be part of a scene"),
    "not a number": ("gravity(0 / 0)", 1, "nan is not a finite number"),
    "infinity": ("gravity(-math.huge)", 1, "-inf is not a finite number"),
    "bytes": ("title('\\255')", 1, "a text is not valid UTF-8"),
    "mixed table": ("panel {1, tilt = 2}", 1, "both list items and named values"),
    "table as key": ("set('panel', {[{}] = 1})", 1, "both list items and named values"),
    "deep source": ("x = " + "{" * 1000, 0, "C stack overflow"),
    "many locals": ("local a " * 1000, 1, "too many local variables"),
    "text as code, old": ("loadstring('x = 1')()", 1, "loadstring is not available"),
    "file as code, old": ("loadfile('init.lua')", 1, "loadfile is not available"),
    "raw access": ("rawset(_G, 'os', 1)", 1, "rawset is not available"),
    "old module": ("module('os')", 1, "module is not available"),
    "upvalue": ("debug.getupvalue(panel, 1)", 1, "debug is not available"),
    "method of all texts": ("('').format = print", 1, "attempt to index a string value"),
    "arithmetic of texts": ("local x = 'x' + 1", 1, "attempt to add a 'string'"),
    "attributes of a word": ("print(panel.__class__)", 1, "attempt to index a function"),
    "change a word": ("panel.__globals__ = 1", 1, "attempt to index a function"),
    "Python's files": ("python.builtins.open('/etc/passwd')", 1, "python is not available"),
    "own environment": ("local _ENV = {}\nos.exit()", 2, "attempt to index a nil value"),
    "catastrophic pattern": (
        "string.find(('a'):rep(1e5), ('a?'):rep(1e4) .. ('a'):rep(1e4))",
        1,
        "string.find is not available",
    ),
    "long fraction": ("string.format('%.99999f', 1)", 1, "invalid conversion"),
    "width from a value": ("string.format('%*d', 1e9, 1)", 1, "invalid conversion"),
    "quoted": ("while true do string.format('%q', ('\\0'):rep(2e6)) end", 1, MEMORY),
    "bytes of a long text": ("string.byte(('x'):rep(7e6), 1, -1)", 1, MEMORY),
    "insert at the front": (
        "local t = {}\nfor i = 1, 1e9 do table.insert(t, 1, i) end",
        2,
        SOFT,
    ),
    "wrong order": (
        "local t = {}\nfor i = 1, 1e4 do t[i] = i end\n"
        "while true do table.sort(t, function() return true end) end",
        3,
        "invalid order function",
    ),
    "suspended coroutine": ("coroutine.create(print)", 1, "coroutine is not available"),
    "mutual recursion": (
        "local f\nlocal function g() return 1 + f() end function f() return 1 + g() end\nf()",
        2,
        MEMORY,
    ),
    "growing arguments": ("local function f(...)\nlocal x = f(1, ...) end\nf()", 2, MEMORY),
    "error function": ("error(print)", 1, "error with a function instead of a message"),
    "NUL in a name": (
        "levelset { shape = mesh { file = 'a\\0b.stl' } }",
        1,
        "is not the name of a file",
    ),
    "run elsewhere": ("run('../elsewhere')", 1, "not '../elsewhere'"),
    "address of a text": ("print(string.format('%-9p', 'x'))", 1, "cannot show addresses (%p)"),
    "order of addresses": ("for k in next, {[{}] = 1} do end", 1, "needs keys that are numbers or"),
    "unknown key": ("next({}, 'x')", 1, "next needs a key of the table"),
    "format of a table": ("string.format('%d', {})", 1, "number expected, got table"),
    "run with a long name": ("run(('x'):rep(1e5))", 1, "xxx..."),
}


@pytest.mark.parametrize("name", SCRIPTS)
def test_hostile_scripts_are_stopped_in_time_with_a_clear_error(name, tmp_path):
    script, line, message = SCRIPTS[name]
    limits = LuaLimits() if message in (SOFT, HARD) else LONG_LIMITS
    error = error_within(TIME_LIMIT, tmp_path, script, limits=limits)
    location = f"init.lua:{line}: " if line else "init.lua: "
    assert error.startswith(location)
    assert message in error
    assert len(error) < 600 and error.isprintable()


def test_removed_functions_are_not_reached_through_texts(tmp_path):
    assert "stopped" in error_of(tmp_path, "while true do local x = ('x'):rep(5):upper() end")
    assert "method 'dump'" in error_of(tmp_path, "string.dump = nil; (''):dump()")


def test_damage_to_the_libraries_hurts_only_the_script(tmp_path):
    damage = """
        function string.byte() error("reached") end
        title 'quoted: "\\n"'
        for _, library in ipairs { string, table, math } do
          for name in next, library do library[name] = nil end
        end
        tostring, type, next, error, select = nil, nil, nil, nil, nil
        preset "lab-50"
        gravity(1.62)
        title 'quoted: "\\n"'
        print "still here"
    """
    printed = []
    (run,) = load(tmp_path, damage, echo=printed.append)
    assert run.scene.data["gravity"] == 1.62
    assert run.scene.data["title"] == 'quoted: "\n"'
    assert printed == ["still here"]


def test_no_text_or_order_depends_on_addresses(tmp_path):
    script = """
        preset "lab-50"
        print({}, print, tostring({}), string.format("%%%s %5d %-9s|%q", {}, 7, tostring, "a"))
        print(("%s"):format(panel), next({}), #tostring(nil))
        local names = {z = 1, a = 2, [3] = 3}
        for key, value in next, names do
          names[key] = nil
          print(key, value)
        end
    """
    printed = []
    load(tmp_path, script, echo=printed.append)
    assert printed[0].split(" ", 3) == ["table", "function", "table", '%table     7 function |"a"']
    assert printed[1:] == ["function nil 3", "3 3", "a 2", "z 1"]


def test_instructions_are_counted(tmp_path):
    error = error_of(tmp_path, "while true do end", limits=LuaLimits(instructions=10_000))
    assert error == "init.lua:1: stopped after 10000 instructions"


def test_an_endless_call_ends_with_the_process(tmp_path):
    unlimited = LuaLimits(instructions=10**15, soft_seconds=1e9, hard_seconds=0.1)
    error = error_within(TIME_LIMIT, tmp_path, "x = 1", "while true do end", limits=unlimited)
    assert error == (
        "init.lua with update.lua: stopped in one operation that takes more than the 0.1 s of "
        "processor time scripts have"
    )
    clock = LuaLimits(instructions=10**15, soft_seconds=1e9, hard_seconds=10, wall_seconds=0.1)
    error = error_of(tmp_path, "while true do end", limits=clock)
    assert error == "init.lua: stopped after 0.1 s by the clock"


def test_output_before_an_error_is_shown(tmp_path):
    printed = []
    error_of(tmp_path, "print('here', 1, nil)\nos.exit()", echo=printed.append)
    assert printed == ["here 1 nil"]


def test_output_is_bounded_and_harmless(tmp_path):
    printed = []
    load(
        tmp_path,
        "preset 'lab-50' for i = 1, 1000 do print('\\27[2J\\255', ('x'):rep(1e4)) end",
        echo=printed.append,
    )
    assert len(printed) == 100
    assert all(len(line) < 600 and line.isprintable() for line in printed)


REDUCED_LIMITS = """
import os, sys
from snowshed.scene.lua import child
child._drop_rights({"hard_seconds": 10, "wall_seconds": 10})
try:
    os.open(os.devnull, os.O_RDONLY)
except OSError as error:
    print(error.strerror)
try:
    bytearray(child.ADDRESS_SPACE)
except MemoryError:
    print("no memory")
"""


def test_the_process_drops_its_rights_to_files_and_memory():
    done = subprocess.run([sys.executable, "-c", REDUCED_LIMITS], capture_output=True, text=True)
    assert done.stdout.splitlines() == [os.strerror(errno.EMFILE), "no memory"], done.stderr


def test_scripts_that_are_too_long_are_refused(tmp_path):
    error = error_of(tmp_path, "x" * (2 << 20))
    assert error == "init.lua: longer than 1 MB"
