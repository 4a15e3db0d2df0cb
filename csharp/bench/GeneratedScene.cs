using System;
using System.Globalization;
using System.Text;
using Kinefab.Numerics;

namespace Kinefab.Bench;

/// <summary>
/// A large scene in the exporter's own layout (one line a component, 12 decimals): modules of hinged links, each with
/// a visual, a collider and its own inertia.  The same bytes for the same size.
/// </summary>
internal static class GeneratedScene
{
    private const int LinksInModule = 19;

    internal static byte[] Write(int gameObjects, out byte[] buffer)
    {
        buffer = GeneratedBuffer.Tetrahedron();
        var text = new StringBuilder();
        text.Append("{\n  \"format\": \"kinefab.scene\",\n  \"version\": \"1.0\",\n");
        text.Append(GeneratedBuffer.Describe(buffer));
        text.Append("  \"gameObjects\": [\n");
        var random = new Random(20261121);
        for (int i = 0; i < gameObjects; i++)
        {
            GameObject(text, i, random);
            text.Append(i + 1 < gameObjects ? ",\n" : "\n");
        }

        return Encoding.UTF8.GetBytes(text.Append("  ]\n}\n").ToString());
    }

    private static void GameObject(StringBuilder text, int index, Random random)
    {
        int module = index / (LinksInModule + 1), link = index % (LinksInModule + 1);
        Vector3d position = Vector(random, 2);
        Quaterniond rotation = Rotation(random);
        if (link == 0)
        {
            Format(text, $"    {{\"id\": \"Plant/Module:{module}\", \"name\": \"Module {module}\", ");
            Format(text, $"\"transform\": {{\"localPosition\": {Json(position)}, \"localRotation\": {Json(rotation)}}}}}");
            return;
        }

        Format(text, $"    {{\"id\": \"Plant/Module:{module}/Link:{link}\", \"name\": \"Link {link}\", \"parent\": {index - link}, ");
        Format(text, $"\"transform\": {{\"localPosition\": {Json(position)}, \"localRotation\": {Json(rotation)}}}, \"components\": [\n");
        Format(text, $"      {{\"type\": \"MeshFilter\", \"mesh\": 0}},\n");
        Format(text, $"      {{\"type\": \"MeshRenderer\", \"materials\": [0]}},\n");
        Body(text, random);
        Format(text, $"      {{\"type\": \"MeshCollider\", \"mesh\": 0, \"convex\": true}}");
        if (link > 1)
            Hinge(text, index, random);
        text.Append("\n    ]}");
    }

    private static void Body(StringBuilder text, Random random)
    {
        double a = random.NextDouble() + 1, b = random.NextDouble() + 1;
        var inertia = new Vector3d(a * 1e-3, b * 1e-3, (a + b) * 0.7e-3);
        Format(text, $"      {{\"type\": \"Rigidbody\", \"mass\": {Json(random.NextDouble() + 0.1)}, ");
        Format(text, $"\"centerOfMass\": {Json(Vector(random, 0.1))}, \"inertiaTensor\": {Json(inertia)}, ");
        Format(text, $"\"inertiaTensorRotation\": {Json(Rotation(random))}}},\n");
    }

    private static void Hinge(StringBuilder text, int index, Random random)
    {
        Format(text, $",\n      {{\"type\": \"HingeJoint\", \"connectedBody\": {index - 1}, \"because\": [\"Insert:{index}\"], ");
        Format(text, $"\"anchor\": {Json(Vector(random, 0.2))}, \"axis\": {Json(Vector(random, 1))}, ");
        Format(text, $"\"useLimits\": true, \"limits\": {{\"min\": -10, \"max\": 80}}}}");
    }

    private static Vector3d Vector(Random random, double size) => size * new Vector3d(Next(random), Next(random), Next(random));

    private static Quaterniond Rotation(Random random) =>
        new Quaterniond(Next(random), Next(random), Next(random), Next(random)).Normalized();

    private static double Next(Random random) => random.NextDouble() * 2 - 1;

    private static string Json(double value) => Math.Round(value, 12).ToString("R", CultureInfo.InvariantCulture);

    private static string Json(Vector3d v) => $"[{Json(v.X)}, {Json(v.Y)}, {Json(v.Z)}]";

    private static string Json(Quaterniond q) => $"[{Json(q.X)}, {Json(q.Y)}, {Json(q.Z)}, {Json(q.W)}]";

    private static void Format(StringBuilder text, FormattableString part) => text.Append(part.ToString(CultureInfo.InvariantCulture));
}
