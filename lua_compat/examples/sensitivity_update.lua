-- The loop over the parameters: all 243 combinations of the values of Table 3.2.1. The thesis has
-- fewer: the 27 combinations of M, p0 and beta with the reference xi and E, and the 9 of xi and E with
-- the reference M, p0 and beta. `snowshed sensitivity --method fixation` computes those.

-- E and p0 in Pa; M, xi and beta have no unit.
local E = { 1e6, 2e6, 3e6 }
local M = { 0.3, 0.5, 0.7 }
local p0 = { 2000, 5000, 8000 }
local xi = { 0.1, 0.2, 1 }
local beta = { 0.1, 0.2, 0.3 }

for _, e in ipairs(E) do
  for _, m in ipairs(M) do
    for _, p in ipairs(p0) do
      for _, x in ipairs(xi) do
        for _, b in ipairs(beta) do
          local name = string.format("E%g-M%g-p%g-xi%g-beta%g", e / 1e6, m, p / 1000, x, b)
          material { E = e, M = m, p0 = p, xi = x, beta = b }
          title("Sensitivity analysis, Table 3.2.1, " .. name)
          run(name)
        end
      end
    end
  end
end
