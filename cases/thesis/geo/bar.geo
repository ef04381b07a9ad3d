// The thesis's bar: 4 x 4 x 16 cells of 1 mm, clamped at z = 0, pulled at the bottom edge x = 0 of its free end.
// A transfinite mesh, unlike the cube's, which is extruded.
width = 4;
length = 16;
Point(1) = {0, 0, 0};          Point(5) = {0, 0, length};
Point(2) = {width, 0, 0};      Point(6) = {width, 0, length};
Point(3) = {width, width, 0};  Point(7) = {width, width, length};
Point(4) = {0, width, 0};      Point(8) = {0, width, length};
Line(1) = {1, 2};  Line(2) = {2, 3};  Line(3) = {3, 4};  Line(4) = {4, 1};
Line(5) = {5, 6};  Line(6) = {6, 7};  Line(7) = {7, 8};  Line(8) = {8, 5};
Line(9) = {1, 5};  Line(10) = {2, 6}; Line(11) = {3, 7}; Line(12) = {4, 8};
Line Loop(1) = {1, 2, 3, 4};      Plane Surface(1) = {1};
Line Loop(2) = {5, 6, 7, 8};      Plane Surface(2) = {2};
Line Loop(3) = {1, 10, -5, -9};   Plane Surface(3) = {3};
Line Loop(4) = {2, 11, -6, -10};  Plane Surface(4) = {4};
Line Loop(5) = {3, 12, -7, -11};  Plane Surface(5) = {5};
Line Loop(6) = {4, 9, -8, -12};   Plane Surface(6) = {6};
Surface Loop(1) = {1, 2, 3, 4, 5, 6};
Volume(1) = {1};

Transfinite Line {1:8} = width + 1;
Transfinite Line {9:12} = length + 1;
Transfinite Surface "*";
Recombine Surface "*";
Transfinite Volume "*";

Physical Volume("tissue") = {1};
Physical Surface("clamped end") = {1};
Physical Surface("free end") = {2};
Physical Line("bottom edge") = {8};
Physical Point("bottom vertex") = {5};
