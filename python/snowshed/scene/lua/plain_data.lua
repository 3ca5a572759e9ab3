-- Returns a function that turns a list of plain values, `count` items from its start, into JSON, so
-- that what leaves Lua is text. It keeps the library as it was before a script could touch it.

local byte, concat, format, gsub = string.byte, table.concat, string.format, string.gsub
local integral, length, next, type = math.type, utf8.len, next, type

local MAX_DEPTH = 64 -- the same as in scenes
local MAX_NUMBER = 1.7976931348623157e308
local ESCAPED = '[%c"\\\127]'

local encode

local function refuse(what)
  error(what, 0)
end

local function escape(character)
  return format("\\u%04x", byte(character))
end

local function encode_text(text)
  if not length(text) then
    refuse("a text is not valid UTF-8")
  end
  return '"' .. gsub(text, ESCAPED, escape) .. '"'
end

local function encode_number(number)
  if integral(number) == "integer" then
    return format("%d", number)
  end
  if not (number >= -MAX_NUMBER and number <= MAX_NUMBER) then
    refuse(format("%g is not a finite number", number))
  end
  return format("%.17g", number)
end

-- How many keys a table has, if they are 1, 2, 3 and so on; else nil.
local function list_length(value)
  local count, last = 0, #value
  for key in next, value do
    if integral(key) ~= "integer" or key < 1 or key > last then
      return nil
    end
    count = count + 1
  end
  return count == last and count or nil
end

local function encode_list(list, count, depth)
  local parts = {}
  for i = 1, count do
    parts[i] = encode(list[i], depth + 1)
  end
  return "[" .. concat(parts, ",") .. "]"
end

local function encode_object(object, depth)
  local parts = {}
  for key, value in next, object do
    if type(key) ~= "string" then
      refuse("a table has both list items and named values, or gaps in its list")
    end
    parts[#parts + 1] = encode_text(key) .. ":" .. encode(value, depth + 1)
  end
  return "{" .. concat(parts, ",") .. "}"
end

local ENCODERS = {
  ["nil"] = function()
    return "null"
  end,
  boolean = function(value)
    return value and "true" or "false"
  end,
  number = encode_number,
  string = encode_text,
  table = function(value, depth)
    if depth > MAX_DEPTH then
      refuse(format("tables are nested more than %d deep", MAX_DEPTH))
    end
    local count = list_length(value)
    if count then
      return encode_list(value, count, depth)
    end
    return encode_object(value, depth)
  end,
}

function encode(value, depth)
  local encoder = ENCODERS[type(value)]
  if not encoder then
    refuse("a " .. type(value) .. " cannot be part of a scene")
  end
  return encoder(value, depth)
end

return encode_list
