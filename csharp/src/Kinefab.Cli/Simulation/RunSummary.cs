using System;
using System.Collections.Generic;
using System.Globalization;
using System.IO;
using System.Linq;
using System.Text.Json;
using Kinefab.Document;
using Kinefab.Dynamics;
using Kinefab.Validation;

namespace Kinefab.Cli.Simulation;

/// <summary>What is worth telling of a run: drift, range, limits and breaking of every joint, what came of the drives, and the energy.</summary>
internal sealed class RunSummary
{
    private readonly World world;
    private readonly ValidScene scene;
    private readonly JointRecord[] joints;
    private readonly DriveRecord[] drives;
    private readonly double startEnergy;

    private readonly SolverKind kind;
    private readonly int steps;
    private readonly double dt;

    internal RunSummary(World world, ValidScene scene, SolverKind kind, int steps, double dt, IEnumerable<DriveSetting> driven)
    {
        this.kind = kind;
        this.steps = steps;
        this.dt = dt;
        this.world = world;
        this.scene = scene;
        joints = world.Joints.Select(j => new JointRecord(j)).ToArray();
        drives = driven.Select(drive => new DriveRecord(drive, dt)).ToArray();
        startEnergy = world.KineticEnergy + world.PotentialEnergy;
        world.JointBroken += (_, e) => joints[IndexOf(e.Joint)].BrokenAt = world.Time;
    }

    /// <summary>Takes note of the step just done.</summary>
    internal void Note()
    {
        foreach (JointRecord joint in joints)
            joint.Note(world.Time);
        foreach (DriveRecord drive in drives)
            drive.Note();
    }

    internal void Write(TextWriter target)
    {
        double end = world.KineticEnergy + world.PotentialEnergy;
        target.WriteLine(Text($"{Counted.Of(steps, "step", "steps")} of {dt} s, {kind.ToString().ToLowerInvariant()} solver"));
        target.WriteLine(Text($"energy {startEnergy:0.####} J -> {end:0.####} J ({end - startEnergy:+0.####;-0.####;0} J)"));
        if (world.Stops > 0)
            target.WriteLine(Text($"the solver could not follow: motion was stopped {Counted.Of(world.Stops, "time", "times")}. Take a shorter --step, or drive it less fast."));
        foreach (JointRecord joint in joints)
            joint.Write(target, scene.Document.GameObjects[joint.Joint.GameObject].Name);
        foreach (DriveRecord drive in drives)
            drive.Write(target);
    }

    /// <summary>The field "simulation" of schemas/report.schema.json into an open JSON object.</summary>
    internal void WriteJson(Utf8JsonWriter json)
    {
        json.WriteStartObject("simulation");
        json.WriteString("solver", kind.ToJson());
        json.WriteNumber("steps", steps);
        json.WriteNumber("step", dt);
        json.WriteNumber("startEnergy", startEnergy);
        json.WriteNumber("endEnergy", world.KineticEnergy + world.PotentialEnergy);
        json.WriteNumber("stops", world.Stops);
        json.WriteStartArray("joints");
        foreach (JointRecord joint in joints)
            joint.WriteJson(json);
        json.WriteEndArray();
        json.WriteStartArray("drives");
        foreach (DriveRecord drive in drives)
            drive.WriteJson(json);
        json.WriteEndArray();
        json.WriteEndObject();
    }

    private int IndexOf(WorldJoint joint) => Array.FindIndex(joints, j => j.Joint == joint);

    private static string Text(FormattableString text) => Printable.Text(text.ToString(CultureInfo.InvariantCulture));

    private sealed class JointRecord
    {
        private readonly Coordinate[] coordinates;
        private readonly double[] least;
        private readonly double[] greatest;
        private double distance;
        private double angle;
        private double? limitAt;

        internal JointRecord(WorldJoint joint)
        {
            Joint = joint;
            coordinates = [.. joint.FreeCoordinates];
            least = coordinates.Select(joint.Coordinate).ToArray();
            greatest = (double[])least.Clone();
        }

        internal WorldJoint Joint { get; }

        internal double? BrokenAt { get; set; }

        internal void Note(double time)
        {
            if (Joint.IsBroken)
                return;
            JointDrift drift = Joint.Drift;
            distance = Math.Max(distance, drift.Distance);
            angle = Math.Max(angle, drift.Angle);
            if (limitAt is null && Joint.IsAtLimit)
                limitAt = time;
            for (int i = 0; i < coordinates.Length; i++)
            {
                double value = Joint.Coordinate(coordinates[i]);
                least[i] = Math.Min(least[i], value);
                greatest[i] = Math.Max(greatest[i], value);
            }
        }

        internal void Write(TextWriter target, string gameObject)
        {
            IEnumerable<string> ranges = coordinates.Select((c, i) => Text(
                $", {c.ToJson()} {Rounded(least[i]):0.#####}..{Rounded(greatest[i]):0.#####}{(c is Coordinate.X or Coordinate.Y or Coordinate.Z ? " m" : " deg")}"));
            string limit = limitAt is double at ? Text($", limit reached at {at:0.###} s") : "";
            string broken = BrokenAt is double when ? Text($", BROKEN at {when:0.###} s") : "";
            target.WriteLine(Text(
                $"{Joint.Name} {(Joint.NameInCad is string name ? $"\"{name}\"" : $"({gameObject})")}: drift {distance:0.0e+0} m, {angle:0.0e+0} deg{string.Concat(ranges)}{limit}{broken}"));
        }

        internal void WriteJson(Utf8JsonWriter json)
        {
            json.WriteStartObject();
            json.WriteString("name", Joint.Name);
            json.WriteString("gameObject", Joint.Id);
            json.WriteNumber("component", Joint.Component);
            json.WriteNumber("drift", distance);
            json.WriteNumber("driftAngle", angle);
            json.WriteStartArray("coordinates");
            for (int i = 0; i < coordinates.Length; i++)
            {
                json.WriteStartObject();
                json.WriteString("coordinate", coordinates[i].ToJson());
                json.WriteString("unit", coordinates[i] is Coordinate.X or Coordinate.Y or Coordinate.Z ? "m" : "deg");
                json.WriteNumber("least", least[i]);
                json.WriteNumber("greatest", greatest[i]);
                json.WriteEndObject();
            }

            json.WriteEndArray();
            if (limitAt is double at)
                json.WriteNumber("limitAt", at);
            if (BrokenAt is double when)
                json.WriteNumber("brokenAt", when);
            json.WriteEndObject();
        }

        // As it is written, without the sign that the format gives a negative number that comes to 0.
        private static double Rounded(double value) => Math.Round(value, 5) + 0.0;
    }
}
