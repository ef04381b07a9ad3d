# Writes bean.stl: a kidney-shaped body of 40 x 24 x 16 mm with a flat base, as triangles seen from outside anticlockwise.
# awk -f bean.awk > bean.stl
# In metres, of fewer triangles, for the template: awk -v n=12 -v m=16 -v digits=7 -v scale=0.001 -f bean.awk
function point(i, j,    u, v, r, x, y, z) {
  if (i == 0 || i == n) j = 0 # the poles are one point each
  j = j % m
  u = pi * i / n; v = 2 * pi * j / m
  x = -20 * cos(u)
  r = sin(u)
  y = 10 * r * cos(v) - 6 * (1 - x * x / 400) # bent: the middle lies back
  z = 10 * r * sin(v) + 6
  if (z < 0) z = 0 # the flat base
  return sprintf(numbers, scale * (x + 20), scale * (y + 16), scale * z)
}
function facet(a, b, c) {
  if (a == b || b == c || a == c) return
  printf "facet normal 0 0 0\nouter loop\nvertex %s\nvertex %s\nvertex %s\nendloop\nendfacet\n", a, b, c
}
BEGIN {
  pi = atan2(0, -1)
  if (!n) { n = 16; m = 20 }
  if (!scale) { scale = 1; digits = 4 }
  number = "%." digits "f"
  numbers = number " " number " " number
  print "solid bean"
  for (i = 0; i < n; ++i)
    for (j = 0; j < m; ++j) {
      facet(point(i, j), point(i, j + 1), point(i + 1, j + 1))
      facet(point(i, j), point(i + 1, j + 1), point(i + 1, j))
    }
  print "endsolid bean"
}
