# Writes probe.stl: an ellipsoid with half axes of 10, 4 and 6 mm about the origin, whose corners are on it. awk -f probe.awk > probe.stl
# With four times as many triangles: awk -v n=32 -v m=48 -f probe.awk
function point(i, j,    u, v) {
  if (i == 0 || i == n) j = 0 # the poles are one point each
  u = pi * i / n; v = 2 * pi * (j % m) / m
  return sprintf("%.4f %.4f %.4f", 10 * sin(u) * cos(v), 4 * sin(u) * sin(v), -6 * cos(u))
}
function facet(a, b, c) {
  if (a == b || b == c || a == c) return
  printf "facet normal 0 0 0\nouter loop\nvertex %s\nvertex %s\nvertex %s\nendloop\nendfacet\n", a, b, c
}
BEGIN {
  pi = atan2(0, -1)
  if (!n) { n = 16; m = 24 }
  print "solid probe"
  for (i = 0; i < n; ++i)
    for (j = 0; j < m; ++j) {
      facet(point(i, j), point(i, j + 1), point(i + 1, j + 1))
      facet(point(i, j), point(i + 1, j + 1), point(i + 1, j))
    }
  print "endsolid probe"
}
