// The thesis's cube: 10 x 10 x 10 cells of 1 mm.
edge = 10;
n = 10;
Point(1) = {0, 0, 0};
along_x[] = Extrude {edge, 0, 0} { Point{1}; Layers{n}; };
along_y[] = Extrude {0, edge, 0} { Line{along_x[1]}; Layers{n}; Recombine; };
along_z[] = Extrude {0, 0, edge} { Surface{along_y[1]}; Layers{n}; Recombine; };

Physical Volume("tissue") = {along_z[1]};
Physical Surface("bottom") = {along_y[1]};
Physical Surface("top") = {along_z[0]};
// The edges of the top face, found by where they lie.
e = 1e-6;
Physical Line("top edge y = 0") = Line In BoundingBox {-e, -e, edge - e, edge + e, e, edge + e};
Physical Line("top edge y = 10") = Line In BoundingBox {-e, edge - e, edge - e, edge + e, edge + e, edge + e};
Physical Line("top edge x = 0") = Line In BoundingBox {-e, -e, edge - e, e, edge + e, edge + e};
Physical Line("top edge x = 10") = Line In BoundingBox {edge - e, -e, edge - e, edge + e, edge + e, edge + e};
Physical Point("top vertex") = Point In BoundingBox {-e, -e, edge - e, e, e, edge + e};
