// A quarter of a thick elliptic plate (NAFEMS LE10), mm: semi-axes 2000 and 1000 of the hole, 3250 and 2750 of the
// rim, thickness 600. Cells grow away from D, the hole's edge on top at (2000, 0, 600). The mid plane is a plane of
// nodes, since its outer edge is held.
n_across = 8; n_around = 16; // cells from the hole to the rim, and of the quarter round
Point(1) = {0, 0, 0};
Point(2) = {2000, 0, 0}; // below D
Point(3) = {3250, 0, 0}; // C
Point(4) = {0, 2750, 0}; // B
Point(5) = {0, 1000, 0}; // A
Line(1) = {2, 3};
Ellipse(2) = {3, 1, 3, 4};
Line(3) = {4, 5};
Ellipse(4) = {5, 1, 2, 2};
Curve Loop(1) = {1, 2, 3, 4};
Plane Surface(1) = {1};
Transfinite Curve {1, -3} = n_across + 1 Using Progression 1.9;
Transfinite Curve {2, -4} = n_around + 1 Using Progression 1.22;
Transfinite Surface {1};
Recombine Surface {1};
lower[] = Extrude {0, 0, 300} { Surface{1}; Layers{2}; Recombine; };
upper[] = Extrude {0, 0, 300} { Surface{lower[0]}; Layers{ {1, 1, 1, 1}, {0.5, 0.85, 0.98, 1} }; Recombine; };
Physical Volume("plate") = {lower[1], upper[1]};
Physical Surface("along x") = {lower[2], upper[2]}; // y = 0, through C and D
Physical Surface("rim") = {lower[3], upper[3]};
Physical Surface("along y") = {lower[4], upper[4]}; // x = 0, through A and B
Physical Surface("top") = {upper[0]};
edges[] = Boundary { Surface{lower[0]}; };
Physical Curve("middle of the rim") = {edges[1]};
