-- Runs scripts that can only compute and call the vocabulary.
--
-- A script sees only the tables made here. These functions are left out on purpose:
--   io, os, debug, package, load, dofile, collectgarbage: they reach out of the sandbox;
--   pcall, coroutine: they could catch the error of an exceeded limit, or run without its hook;
--   setmetatable, getmetatable: finalisers and __close run without the hook;
--   string.find, match, gmatch, gsub, table.move: one call may take forever, and hooks do not run
--   inside a call.
--
-- Arguments: the result of plain_data.lua, the words, the shapes, the limits, and the modules that
-- `require` finds: number and text by name.

local encode_list, words, shapes, limits, modules = ...

local clock, concat, create, error = os.clock, table.concat, coroutine.create, error
local format, getinfo, load, next = string.format, debug.getinfo, load, next
local rep, resume, select, sethook = string.rep, coroutine.resume, select, debug.sethook
local gmatch, match, randomseed, sub = string.gmatch, string.match, math.randomseed, string.sub
local sort, tonumber, type, number_type = table.sort, tonumber, type, math.type
local rawset, setmetatable, unpack = rawset, setmetatable, table.unpack
local library_tostring = tostring

local INTERVAL = 200 -- instructions between two looks at the limits

local calls, printed = {}, {}
local unset = {} -- script, line and name of each variable that was read without a value
local main -- the coroutine that runs the scripts
local current = 1 -- the number of the script that runs
local env = {}

-- Returns the number of the script and its current line, or the line at which `main` failed. The
-- line is 0 if it is unknown, because a call in the script's own `return` has replaced it.
local function place()
  for level = 0, 200 do
    local info = getinfo(main, level, "Sl")
    if not info then
      break
    end
    local script = match(info.source, "^=script(%d+)$")
    if script then
      return tonumber(script), info.currentline
    end
  end
  return current, 0
end

-- --- functions for scripts -------------------------------------------------------------------

local function ordered(one, other)
  local a, b = type(one), type(other)
  if a == b then
    return one < other
  end
  return a < b
end

-- Lua visits keys in an order that differs from run to run; here the order is fixed.
local function sorted_keys(caller, values)
  if type(values) ~= "table" then
    error(format("%s needs a table, not a %s", caller, type(values)), 0)
  end
  local keys = {}
  for key in next, values do
    if type(key) ~= "string" and type(key) ~= "number" then
      error(format("%s needs keys that are numbers or texts, not a %s", caller, type(key)), 0)
    end
    keys[#keys + 1] = key
  end
  sort(keys, ordered)
  return keys
end

local function sorted_pairs(values)
  local keys = sorted_keys("pairs", values)
  local i = 0
  return function()
    i = i + 1
    return keys[i], values[keys[i]]
  end
end

local chains = setmetatable({}, { __mode = "k" }) -- by table: each key's successor

local function begin_chain(values)
  local keys, chain = sorted_keys("next", values), {}
  for i = 1, #keys do
    chain[keys[i]] = keys[i + 1] or false
  end
  chains[values] = chain
  return keys[1]
end

local function sorted_next(values, key)
  if key == nil then
    key = begin_chain(values)
    return key, values[key]
  end
  if not chains[values] then
    begin_chain(values)
  end
  repeat -- skip keys that the loop has removed
    key = chains[values][key]
    if key == nil then
      error("next needs a key of the table", 0)
    end
  until not key or values[key] ~= nil
  return key or nil, values[key]
end

-- The library prints addresses, which differ from run to run; here they are left out.
local function without_address(value)
  local kind = type(value)
  return (kind == "table" or kind == "function") and kind or value
end

local function tostring(value)
  return library_tostring(without_address(value))
end

local function format_without_addresses(form, ...)
  local values, count = { ... }, select("#", ...)
  local i = 0
  for kind in gmatch(library_tostring(form), "%%[-+ #0-9.]*(.)") do
    if kind == "p" then
      error("string.format cannot show addresses (%p)", 0)
    elseif kind ~= "%" then
      i = i + 1
      if kind == "s" then
        values[i] = without_address(values[i])
      end
    end
  end
  return format(form, unpack(values, 1, count))
end

-- The library's function may repeat an empty text forever.
local function bounded_rep(text, count, separator)
  local size = #tostring(text) + #tostring(separator or "")
  if size == 0 then
    return ""
  end
  size = size * (tonumber(count) or 0)
  if size > limits.memory_bytes then
    error(format("string.rep would make a text of %.3g bytes", size), 0)
  end
  return rep(text, count, separator)
end

-- A table with gaps may claim any length, all of which the library would visit in one call.
local function bounded_list(name, work)
  return function(list, ...)
    if type(list) == "table" and #list * 16 > limits.memory_bytes then
      error(format("table.%s of a list that claims %d items", name, #list), 0)
    end
    return work(list, ...)
  end
end

local function print_later(...)
  local parts = { ... }
  for i = 1, select("#", ...) do
    parts[i] = tostring(parts[i])
  end
  if #printed < limits.printed_lines then
    printed[#printed + 1] = sub(concat(parts, "\t"), 1, limits.line_length)
  end
end

-- Without a number the library would use the time of day as seed.
local function seed_random(seed)
  randomseed(seed)
end

local function recorder(word)
  return function(...)
    if #calls >= limits.calls then
      error(format("more than %d calls of the vocabulary", limits.calls), 0)
    end
    local script, line = place()
    local arguments = encode_list({ ... }, select("#", ...), 0)
    calls[#calls + 1] = format('["%s",%d,%d,%s]', word, script, line, arguments)
  end
end

-- Named values are properties of the shape; list items are its parts.
local function shape_maker(name, kind)
  return function(values)
    if type(values) ~= "table" then
      error(format("%s needs a table of values, not a %s", name, type(values)), 0)
    end
    local shape, parts = { type = kind }, nil
    for key, value in next, values do
      if number_type(key) == "integer" then
        parts = parts or {}
        parts[key] = value
      else
        shape[key] = value
      end
    end
    shape.shapes = parts or shape.shapes
    return shape
  end
end

local function refusal(name)
  return function()
    error(name .. " is not available to scene scripts", 0)
  end
end

-- A library in which a call of a left-out function is an error that says so.
local function restricted(library_name, library, names)
  local chosen = {}
  for name in next, library do
    chosen[name] = refusal(library_name .. "." .. name)
  end
  for _, name in next, names do
    chosen[name] = library[name]
  end
  return chosen
end

local FORBIDDEN_TABLES = { "io", "os", "debug", "package", "coroutine", "utf8", "python" }
local FORBIDDEN_FUNCTIONS = {
  "collectgarbage", "dofile", "getfenv", "getmetatable", "load", "loadfile", "loadstring",
  "module", "pcall", "rawequal", "rawget", "rawlen", "rawset", "setfenv",
  "setmetatable", "warn", "xpcall",
}

local ALLOWED_FUNCTIONS = {
  "_VERSION", "assert", "error", "ipairs", "select", "tonumber", "type",
}
local ALLOWED_OF_STRING = { "byte", "char", "len", "lower", "reverse", "sub", "upper" }

local results = {} -- of modules, by name

-- Runs the script of a name once, and returns its result.
local function require_module(name)
  local module = modules[name]
  if type(name) ~= "string" or not module then
    error(format("require: there is no %s.lua beside the script", tostring(name)), 0)
  end
  if results[name] == nil then
    results[name] = true -- a module that requires itself sees this
    local chunk, message = load(module.text, "=script" .. module.number, "t", env)
    if not chunk then
      error(message, 0)
    end
    local result = chunk()
    if result ~= nil then
      results[name] = result
    end
  end
  return results[name]
end

local function forbid()
  for _, name in next, FORBIDDEN_TABLES do
    local refuse = refusal(name)
    env[name] = setmetatable({}, { __index = refuse, __newindex = refuse, __call = refuse })
  end
  for _, name in next, FORBIDDEN_FUNCTIONS do
    env[name] = refusal(name)
  end
end

-- Makes the names of the vocabulary constant, and records names that are read without a value.
-- Without this, `panel = { tilt = 50 }` in place of `panel { tilt = 50 }` would replace a function
-- and set nothing, and `panel { condition = SEPERATE }` would leave the condition as it is.
local function guard_names()
  local vocabulary = {}
  for _, names in next, { words, shapes } do
    for key, value in next, names do
      local name = names == words and value or key
      vocabulary[name], env[name] = env[name], nil
    end
  end
  local function reading(name)
    local script, line = place()
    return format("%d:%d:%s", script, line, sub(name, 1, limits.line_length))
  end
  setmetatable(env, {
    __index = function(_, name)
      if vocabulary[name] == nil and type(name) == "string" and #unset < limits.printed_lines then
        unset[#unset + 1] = reading(name)
      end
      return vocabulary[name]
    end,
    __newindex = function(variables, name, value)
      if vocabulary[name] then
        error(format("%s = ... sets nothing; call %s, without the equals sign", name, name), 0)
      end
      -- `x = x or 3` gives x a default.
      if type(name) == "string" and unset[#unset] == reading(name) then unset[#unset] = nil end
      rawset(variables, name, value)
    end,
  })
end

local function fill_environment()
  forbid()
  for _, name in next, ALLOWED_FUNCTIONS do
    env[name] = _G[name]
  end
  env._G, env.pairs, env.print, env.unpack = env, sorted_pairs, print_later, unpack
  env.next, env.tostring, env.require = sorted_next, tostring, require_module
  env.string = restricted("string", string, ALLOWED_OF_STRING)
  env.string.rep, env.string.format = bounded_rep, format_without_addresses
  env.table = restricted("table", table, { "pack", "unpack" })
  for _, name in next, { "concat", "insert", "remove", "sort" } do
    env.table[name] = bounded_list(name, table[name])
  end
  env.math = math
  env.math.randomseed = seed_random
  env.STICKY, env.SLIP, env.SEPARATE = "sticky", "slip", "separate"
  for _, word in next, words do
    env[word] = recorder(word)
  end
  for name, kind in next, shapes do
    env[name] = shape_maker(name, kind)
  end
  guard_names()
  getmetatable("").__index = env.string -- ("text"):rep is env.string.rep
end

-- --- running ---------------------------------------------------------------------------------

local function watch_limits()
  local instructions, start = 0, clock()
  return function()
    instructions = instructions + INTERVAL
    if instructions > limits.instructions then
      error(format("stopped after %d instructions", limits.instructions), 0)
    end
    if clock() - start > limits.soft_seconds then
      error(format("stopped after %g s", limits.soft_seconds), 0)
    end
  end
end

-- Runs the texts one after the other in the same environment. Returns nothing, or an error message;
-- `place` then returns the position of the error.
local function run(texts)
  main = create(function()
    for i = 1, #texts do
      current = i
      local chunk, message = load(texts[i], "=script" .. i, "t", env)
      if not chunk then
        error(message, 0)
      end
      if chunk() ~= nil then
        error("the script returns a value, which sets nothing; call words such as panel { }", 0)
      end
    end
  end)
  sethook(main, watch_limits(), "", INTERVAL)
  local done, message = resume(main)
  if done then
    return nil
  end
  if type(message) ~= "string" then
    message = "error with a " .. type(message) .. " instead of a message"
  end
  return message
end

randomseed(0) -- the same script makes the same scene
fill_environment()
return { run = run, place = place, calls = calls, printed = printed, unset = unset }
