// A cube of 4 x 4 x 4 cells of 1 mm, and beside it, 2 mm away, one of 2 x 2 x 2.
size = 4;
Point(1) = {0, 0, 0};
along_x[] = Extrude {size, 0, 0} { Point{1}; Layers{size}; };
along_y[] = Extrude {0, size, 0} { Line{along_x[1]}; Layers{size}; Recombine; };
along_z[] = Extrude {0, 0, size} { Surface{along_y[1]}; Layers{size}; Recombine; };

small = 2;
p = newp;
Point(p) = {size + 2, 0, 0};
apart_x[] = Extrude {small, 0, 0} { Point{p}; Layers{small}; };
apart_y[] = Extrude {0, small, 0} { Line{apart_x[1]}; Layers{small}; Recombine; };
apart_z[] = Extrude {0, 0, small} { Surface{apart_y[1]}; Layers{small}; Recombine; };

Physical Volume("tissue") = {along_z[1], apart_z[1]};
Physical Surface("bottom") = {along_y[1]};
Physical Surface("top") = {along_z[0]};
