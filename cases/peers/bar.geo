// A bar of 10 x 10 x 20 mm in twelve tetrahedra. The programs refine it, not gmsh.
Point(1) = {0, 0, 0};
along_x[] = Extrude {10, 0, 0} { Point{1}; Layers{1}; };
along_y[] = Extrude {0, 10, 0} { Line{along_x[1]}; Layers{1}; };
along_z[] = Extrude {0, 0, 20} { Surface{along_y[1]}; Layers{2}; };

Physical Volume("tissue") = {along_z[1]};
Physical Surface("lower end") = {along_y[1]};
Physical Surface("upper end") = {along_z[0]};
