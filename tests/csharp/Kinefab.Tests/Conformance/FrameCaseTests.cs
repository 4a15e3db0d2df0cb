using System.Collections.Generic;
using System.IO;
using System.Linq;
using System.Text.Json;
using MathNet.Numerics.LinearAlgebra;
using NUnit.Framework;

namespace Kinefab.Tests.Conformance;

/// <summary>
/// The exporter's number pairs, worked out a second time: with N = M * turn (determinant -1), polar quantities become
/// N v, axial ones -N v, matrices N A N^T; lengths take the unit.
/// </summary>
public class FrameCaseTests
{
    private static readonly Matrix<double> Mirror = Matrix<double>.Build.DenseOfDiagonalArray([-1, 1, 1]);

    private static IEnumerable<string> Paths => ConformanceCases.All.Where(entry => entry.Kind == "frames").Select(entry => entry.Path);

    [TestCaseSource(nameof(Paths))]
    public void Pairs_OfASource_FollowFromItsAxesAndUnit(string path)
    {
        using JsonDocument content = JsonDocument.Parse(File.ReadAllText(Path.Combine(ConformanceCases.Folder, path)));
        JsonElement source = content.RootElement.GetProperty("source");
        Matrix<double> map = Mirror * Turn(source.GetProperty("up").GetString()!, source.GetProperty("forward").GetString()!);
        double unit = source.GetProperty("metersPerUnit").GetDouble();
        using (Assert.EnterMultipleScope())
        {
            foreach (JsonElement pair in content.RootElement.GetProperty("pairs").EnumerateArray())
            {
                string quantity = pair.GetProperty("quantity").GetString()!;
                double[] expected = Flat(pair.GetProperty("unity"));
                Assert.That(Mapped(quantity, Flat(pair.GetProperty("given")), map, unit), Is.EqualTo(expected).Within(1e-12), quantity);
            }
        }
    }

    /// <summary>Rows: right, up and forward of the source in its own axes.</summary>
    private static Matrix<double> Turn(string up, string forward)
    {
        Vector<double> u = Axis(up), f = Axis(forward);
        Vector<double> right = Vector<double>.Build.Dense([u[1] * f[2] - u[2] * f[1], u[2] * f[0] - u[0] * f[2], u[0] * f[1] - u[1] * f[0]]);
        return Matrix<double>.Build.DenseOfRowVectors(right, u, f);
    }

    private static Vector<double> Axis(string name)
    {
        Vector<double> axis = Vector<double>.Build.Dense(3);
        axis["XYZ".IndexOf(name[^1])] = name[0] == '-' ? -1 : 1;
        return axis;
    }

    private static double[] Mapped(string quantity, double[] given, Matrix<double> map, double unit) => quantity switch
    {
        "point" => Polar(given, map, unit),
        "direction" or "normal" or "force" => Polar(given, map, 1),
        "axis" or "angularVelocity" or "torque" => Polar(given, map, -1),
        "quaternion" => [.. Polar(given[..3], map, -1), given[3]],
        "rotation" or "inertia" => (map * Matrix<double>.Build.DenseOfRowMajor(3, 3, given) * map.Transpose()).ToRowMajorArray(),
        "triangle" => [given[0], given[2], given[1]],
        "angleAboutDirection" => [-given[0]],
        "angleAboutAxis" => given,
        "distanceAlongDirection" => [given[0] * unit],
        // A screw's lead is a length for each turn about the same line: polar over axial.
        "screwLead" => [-given[0] * unit],
        _ => throw new InvalidDataException("No rule for " + quantity),
    };

    private static double[] Polar(double[] v, Matrix<double> map, double factor) => (map * Vector<double>.Build.Dense(v) * factor).ToArray();

    private static double[] Flat(JsonElement value) => value.ValueKind == JsonValueKind.Array
        ? value.EnumerateArray().SelectMany(Flat).ToArray()
        : [value.GetDouble()];
}
