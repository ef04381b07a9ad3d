// A wedge of hexahedra, for gmsh. Every volume is recombined from a transfinite surface.
SetFactory("Built-in");
Point(1) = {0, 0, 0};
Point(2) = {10, 0, 0};
Point(3) = {10, 10, 0};
Point(4) = {0, 6, 0};
Line(1) = {1, 2};
Line(2) = {2, 3};
Line(3) = {3, 4};
Line(4) = {4, 1};
Curve Loop(1) = {1, 2, 3, 4};
Plane Surface(1) = {1};
Transfinite Curve {1, 3} = 9; // 8 cells
Transfinite Curve {2, 4} = 7;
Transfinite Surface {1};
Recombine Surface {1};
body[] = Extrude {0, 0, 12} { Surface {1}; Layers {8}; Recombine; };
// Regions of the case are these names.
Physical Volume("tissue") = {body[1]};
Physical Surface("bottom") = {1};
Physical Surface("top") = {body[0]};
