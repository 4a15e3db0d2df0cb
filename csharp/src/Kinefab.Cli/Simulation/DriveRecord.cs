using System.IO;
using System.Text.Json;
using Kinefab.Cli.Motion;
using Kinefab.Document;

namespace Kinefab.Cli.Simulation;

/// <summary>A drive and what came of it at the end of a run. A speed is that over the last step.</summary>
internal sealed class DriveRecord(DriveSetting drive, double step)
{
    private double before = drive.Value;
    private double now = drive.Value;

    private double Reached => drive.IsSpeed ? (now - before) / step : now;

    /// <summary>Takes note of the step just done.</summary>
    internal void Note() => (before, now) = (now, drive.Value);

    internal void Write(TextWriter target) => target.WriteLine(Printable.Text(
        $"drive {drive.Coordinate.ShortName}: asked {CoordinateText.Number(drive.Asked)} {drive.Unit}, reached {CoordinateText.Number(Reached)} {drive.Unit}"));

    internal void WriteJson(Utf8JsonWriter json)
    {
        json.WriteStartObject();
        json.WriteString("drive", drive.Text);
        json.WriteString("gameObject", drive.Joint.Id);
        json.WriteNumber("component", drive.Joint.Component);
        json.WriteString("coordinate", drive.Coordinate.Coordinate.ToJson());
        json.WriteString("unit", drive.Unit);
        json.WriteNumber("asked", drive.Asked);
        json.WriteNumber("reached", Reached);
        json.WriteEndObject();
    }
}
