// Forces of the springs and other terms of a folder that `springproof export CASE --to csv` wrote; N and mm.
// Plain C#, for Unity or any other program:
//     var terms = Forces.Read(folder);
//     double[] f = Forces.At(terms, x);   // x: places of the nodes, x, y and z of each; f likewise
// Forces.Check(folder) compares them with check.csv.
using System;
using System.Collections.Generic;
using System.Globalization;
using System.IO;
using System.Linq;

namespace Springproof {

// A spring between two nodes, or between the means of two sets of nodes (a midline).
public struct Spring {
  public int[] A, B;
  public double Stiffness, RestLength;  // N/mm, mm
  public double? Exponent;              // of the power-log law; none: Hooke's

  public double Tension(double length) {
    if (Exponent == null) return Stiffness * (length - RestLength);
    double q = length / RestLength;
    return Stiffness * RestLength * Math.Pow(q, Exponent.Value) * Math.Log(q);
  }
}

// The volume under triangles of nodes, of which a part counts: half of both triangulations of a hexahedron's
// faces, a quarter of the tetrahedra around a node.
public struct Volume {
  public List<int[]> Triangles;
  public double Part, Stiffness, RestVolume;  // MPa, mm^3
  public bool IsLogarithmic;
}

// Four nodes, whose edges' squared lengths have the energy 1/2 sum K_ef D_e D_f, D_e = l_e^2 - L_e^2.
public struct Tetrahedron {
  public int[] Nodes;
  public double[] RestLengths;   // mm
  public double[,] Stiffness;    // N/mm^3
}

public class Terms {
  public double[] Rest;  // mm
  public List<Spring> Springs = new List<Spring>();
  public List<Volume> Volumes = new List<Volume>();
  public List<Tetrahedron> Tetrahedra = new List<Tetrahedron>();
}

public static class Forces {
  static readonly int[,] Edges = { { 0, 1 }, { 0, 2 }, { 0, 3 }, { 1, 2 }, { 1, 3 }, { 2, 3 } };
  // Faces of a hexahedron whose vertex is i + 2j + 4k, and of a tetrahedron, anticlockwise from outside.
  static readonly int[,] Faces = {
    { 0, 4, 6, 2 }, { 1, 3, 7, 5 }, { 0, 1, 5, 4 }, { 2, 6, 7, 3 }, { 0, 2, 3, 1 }, { 4, 5, 7, 6 }
  };
  static readonly int[,] TetrahedronFaces = { { 0, 2, 1 }, { 0, 1, 3 }, { 0, 3, 2 }, { 1, 2, 3 } };

  public static double[] At(Terms terms, double[] x) {
    var force = new double[x.Length];
    foreach (Spring spring in terms.Springs) AddSpring(force, x, spring);
    foreach (Volume volume in terms.Volumes) AddVolume(force, x, volume);
    foreach (Tetrahedron tetrahedron in terms.Tetrahedra) AddTetrahedron(force, x, tetrahedron);
    return force;
  }

  static void AddSpring(double[] force, double[] x, Spring spring) {
    var d = new double[3];
    for (int c = 0; c < 3; ++c)
      d[c] = spring.B.Average(n => x[3 * n + c]) - spring.A.Average(n => x[3 * n + c]);
    double length = Math.Sqrt(d.Sum(a => a * a)), pull = spring.Tension(length) / length;
    for (int c = 0; c < 3; ++c) {
      foreach (int n in spring.A) force[3 * n + c] += pull * d[c] / spring.A.Length;
      foreach (int n in spring.B) force[3 * n + c] -= pull * d[c] / spring.B.Length;
    }
  }

  // The volume under a triangle is a . (b x c) / 6, seen from a node of the body: far from the origin digits
  // would be lost.
  static void AddVolume(double[] force, double[] x, Volume term) {
    int origin = term.Triangles[0][0];
    double sum = 0;
    foreach (int[] t in term.Triangles) {
      double[] normal = Cross(x, origin, t[1], t[2]);
      for (int c = 0; c < 3; ++c) sum += (x[3 * t[0] + c] - x[3 * origin + c]) * normal[c];
    }
    double ratio = term.Part * sum / 6 / term.RestVolume;
    double pressure = term.Stiffness * (term.IsLogarithmic ? Math.Log(ratio) : ratio - 1);
    foreach (int[] t in term.Triangles)
      for (int v = 0; v < 3; ++v) {
        double[] normal = Cross(x, origin, t[(v + 1) % 3], t[(v + 2) % 3]);
        for (int c = 0; c < 3; ++c) force[3 * t[v] + c] -= pressure * term.Part / 6 * normal[c];
      }
  }

  static double[] Cross(double[] x, int origin, int a, int b) {
    var product = new double[3];
    for (int c = 0; c < 3; ++c) {
      int i = (c + 1) % 3, j = (c + 2) % 3;
      product[c] = (x[3 * a + i] - x[3 * origin + i]) * (x[3 * b + j] - x[3 * origin + j])
                   - (x[3 * a + j] - x[3 * origin + j]) * (x[3 * b + i] - x[3 * origin + i]);
    }
    return product;
  }

  static void AddTetrahedron(double[] force, double[] x, Tetrahedron term) {
    var change = new double[6];
    for (int e = 0; e < 6; ++e) {
      for (int c = 0; c < 3; ++c) change[e] += Math.Pow(Along(x, term, e, c), 2);
      change[e] -= term.RestLengths[e] * term.RestLengths[e];
    }
    for (int e = 0; e < 6; ++e) {
      double pull = 0;
      for (int f = 0; f < 6; ++f) pull += 2 * term.Stiffness[e, f] * change[f];
      for (int c = 0; c < 3; ++c) {
        double component = pull * Along(x, term, e, c);
        force[3 * term.Nodes[Edges[e, 0]] + c] += component;
        force[3 * term.Nodes[Edges[e, 1]] + c] -= component;
      }
    }
  }

  static double Along(double[] x, Tetrahedron term, int e, int c) {
    return x[3 * term.Nodes[Edges[e, 1]] + c] - x[3 * term.Nodes[Edges[e, 0]] + c];
  }

  public static Terms Read(string folder) {
    var terms = new Terms();
    terms.Rest = Rows(folder, "nodes.csv").SelectMany(row => row.Skip(1).Take(3)).Select(Number).ToArray();
    foreach (string[] row in Rows(folder, "springs.csv"))
      terms.Springs.Add(SpringOf(row.Skip(2).ToArray(), Nodes(row, 0, 1), Nodes(row, 1, 1)));
    foreach (string[] row in Rows(folder, "midlines.csv"))
      terms.Springs.Add(SpringOf(row, Nodes(row, 3, 4), Nodes(row, 7, 4)));
    foreach (string[] row in Rows(folder, "volume_terms.csv")) {
      int[] nodes = Nodes(row, 3, 8);
      var triangles = new List<int[]>();
      for (int f = 0; f < 6; ++f)
        foreach (var t in new[] { new[] { 0, 1, 2 }, new[] { 0, 2, 3 }, new[] { 0, 1, 3 }, new[] { 1, 2, 3 } })
          triangles.Add(t.Select(v => nodes[Faces[f, v]]).ToArray());
      terms.Volumes.Add(VolumeOf(row, triangles, 0.5));
    }
    foreach (var patch in Rows(folder, "volume_patches.csv").GroupBy(row => row[0])) {
      var triangles = new List<int[]>();
      foreach (string[] row in patch)
        for (int f = 0; f < 4; ++f)
          triangles.Add(Enumerable.Range(0, 3).Select(v => Nodes(row, 4, 4)[TetrahedronFaces[f, v]]).ToArray());
      terms.Volumes.Add(VolumeOf(patch.First().Skip(1).ToArray(), triangles, 0.25));
    }
    foreach (string[] row in Rows(folder, "tetrahedra.csv")) {
      var stiffness = new double[6, 6];
      for (int i = 0; i < 36; ++i) stiffness[i / 6, i % 6] = Number(row[10 + i]);
      double[] lengths = row.Skip(4).Take(6).Select(Number).ToArray();
      terms.Tetrahedra.Add(
        new Tetrahedron { Nodes = Nodes(row, 0, 4), RestLengths = lengths, Stiffness = stiffness });
    }
    return terms;
  }

  // Largest difference from the forces of check.csv, over the largest of these.
  public static double Check(string folder) {
    Terms terms = Read(folder);
    var state = Rows(folder, "check.csv").Select(row => row.Skip(1).Select(Number).ToArray()).ToArray();
    var x = (double[])terms.Rest.Clone();
    for (int i = 0; i < x.Length; ++i) x[i] += state[i / 3][i % 3];
    double[] force = At(terms, x);
    double largest = 0, difference = 0;
    for (int i = 0; i < x.Length; ++i) {
      double expected = state[i / 3][3 + i % 3], off = Math.Abs(force[i] - expected);
      largest = Math.Max(largest, Math.Abs(expected));
      difference = Math.Max(difference, off);  // which is NaN where one is
    }
    return difference / largest;
  }

  // Stiffness in N/m, rest length in mm, and an exponent or nothing.
  static Spring SpringOf(string[] law, int[] a, int[] b) {
    return new Spring {
      A = a, B = b, Stiffness = 1e-3 * Number(law[0]), RestLength = Number(law[1]),
      Exponent = law[2] == "" ? (double?)null : Number(law[2])
    };
  }

  static Volume VolumeOf(string[] law, List<int[]> triangles, double part) {
    return new Volume {
      Triangles = triangles, Part = part, Stiffness = Number(law[0]), RestVolume = Number(law[1]),
      IsLogarithmic = law[2] == "logarithmic"
    };
  }

  static int[] Nodes(string[] row, int first, int n) {
    return row.Skip(first).Take(n).Select(text => int.Parse(text, CultureInfo.InvariantCulture)).ToArray();
  }

  static double Number(string text) { return double.Parse(text, CultureInfo.InvariantCulture); }

  // The lines of a file without its header; none where there is no file.
  static IEnumerable<string[]> Rows(string folder, string name) {
    string file = Path.Combine(folder, name);
    return File.Exists(file) ? File.ReadAllLines(file).Skip(1).Select(line => line.Split(',')) : new string[0][];
  }
}

}
