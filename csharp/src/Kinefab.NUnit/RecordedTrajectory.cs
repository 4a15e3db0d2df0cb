using System;
using System.Collections.Generic;
using System.IO;
using System.Linq;
using System.Text.Json;
using Kinefab.Document;
using Kinefab.Dynamics;
using Kinefab.Numerics;

namespace Kinefab.NUnit;

/// <summary>A trajectory file (schemas/trajectory.schema.json): poses over time or over a driven coordinate.</summary>
internal sealed class RecordedTrajectory
{
    private RecordedTrajectory(JsonElement file)
    {
        IsDriven = file.TryGetProperty("driver", out JsonElement driver);
        if (IsDriven)
        {
            DriverId = driver.GetProperty("id").GetString()!;
            DriverComponent = driver.GetProperty("component").GetInt32();
            DriverCoordinate = Enum.Parse<Coordinate>(driver.GetProperty("coordinate").GetString()!, ignoreCase: true);
        }
        else
        {
            Step = file.GetProperty("step").GetDouble() is > 0 and < double.PositiveInfinity and double step
                ? step
                : throw new InvalidDataException("Its step is no positive number of seconds.");
            Solver = file.GetProperty("solver").GetString() == "unity" ? SolverKind.Unity : SolverKind.Exact;
        }

        At = Numbers(IsDriven ? driver.GetProperty("values") : file.GetProperty("times"));
        Bodies = file.GetProperty("bodies").EnumerateArray()
            .Select(body => (body.GetProperty("id").GetString()!, body.GetProperty("poses").EnumerateArray().Select(PoseOf).ToArray())).ToList();
        if (Bodies.Count == 0 || At.Length == 0)
            throw new InvalidDataException($"It has no {(Bodies.Count == 0 ? "bodies" : IsDriven ? "values" : "times")}, and would hold of any motion.");
        if (Bodies.Any(body => body.Poses.Length != At.Length))
            throw new InvalidDataException("A body has not one pose for each time or value.");
    }

    /// <summary>Over a driven coordinate; else over time.</summary>
    public bool IsDriven { get; }

    /// <summary>The driven joint's GameObject.</summary>
    public string DriverId { get; } = "";

    public int DriverComponent { get; }

    public Coordinate DriverCoordinate { get; }

    /// <summary>Seconds between two steps, of a motion over time.</summary>
    public double Step { get; }

    /// <summary>Who made a motion over time.</summary>
    public SolverKind Solver { get; }

    /// <summary>Seconds, or values of the driver in degrees or metres.</summary>
    public double[] At { get; }

    /// <summary>World poses by the object's id.</summary>
    public IReadOnlyList<(string Id, Pose[] Poses)> Bodies { get; }

    /// <summary>Reads a file.</summary>
    /// <exception cref="InvalidDataException">It cannot be read, or is no trajectory; the message says why.</exception>
    public static RecordedTrajectory Read(string path)
    {
        try
        {
            using JsonDocument file = JsonDocument.Parse(File.ReadAllBytes(path));
            return new RecordedTrajectory(file.RootElement);
        }
        catch (Exception fault) when (fault is FileNotFoundException or DirectoryNotFoundException)
        {
            throw new InvalidDataException($"there is no file {path} (from {Directory.GetCurrentDirectory()}); dotnet kinefab sweep SCENE --joint JOINT -o {path} records one", fault);
        }
        catch (Exception fault) when (fault is IOException or UnauthorizedAccessException)
        {
            throw new InvalidDataException($"{path} cannot be read: {fault.Message}", fault);
        }
        catch (Exception fault) when (fault is JsonException or KeyNotFoundException or InvalidOperationException or FormatException or ArgumentException or InvalidDataException)
        {
            throw new InvalidDataException($"{path} is no trajectory of dotnet kinefab: {fault.Message}", fault);
        }
    }

    private static double[] Numbers(JsonElement list) => list.EnumerateArray().Select(number => number.GetDouble()).ToArray();

    private static Pose PoseOf(JsonElement pose)
    {
        double[] n = Numbers(pose);
        return n.Length == 7
            ? new Pose(new Vector3d(n[0], n[1], n[2]), new Quaterniond(n[3], n[4], n[5], n[6]))
            : throw new InvalidDataException("A pose has seven numbers.");
    }
}
