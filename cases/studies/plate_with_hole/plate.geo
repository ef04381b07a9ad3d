// A quarter of a plate with a round hole, all hexahedra: 10 mm hole radius in 100 x 100 mm, 8 mm thick.
SetFactory("Built-in");
radius = 10; half_width = 100; thickness = 8;
n_around = 8; // cells along each half of the hole's quarter
n_outward = 24;
s = radius * Sqrt(0.5);
Point(1) = {0, 0, 0};
Point(2) = {radius, 0, 0};
Point(3) = {s, s, 0};
Point(4) = {0, radius, 0};
Point(5) = {half_width, 0, 0};
Point(6) = {half_width, half_width, 0};
Point(7) = {0, half_width, 0};
Circle(1) = {2, 1, 3};
Circle(2) = {3, 1, 4};
Line(3) = {2, 5};
Line(4) = {3, 6};
Line(5) = {4, 7};
Line(6) = {5, 6};
Line(7) = {6, 7};
Curve Loop(1) = {3, 6, -4, -1};
Curve Loop(2) = {4, 7, -5, -2};
Plane Surface(1) = {1};
Plane Surface(2) = {2};
Transfinite Curve {1, 2, 6, 7} = n_around + 1;
Transfinite Curve {3, 4, 5} = n_outward + 1 Using Progression 1.1; // cells grow with their distance
Transfinite Surface {1, 2};
Recombine Surface {1, 2};
plate[] = Extrude {0, 0, thickness} { Surface {1, 2}; Layers {2}; Recombine; };
Physical Volume("plate") = {plate[1], plate[7]};
Physical Surface("pulled") = {plate[3]}; // x = half_width
