using System;
using System.Collections.Generic;
using System.Linq;
using Kinefab.Document;
using Kinefab.Kinematics;

namespace Kinefab.Cli.Motion;

/// <summary>
/// ID or ID.COORDINATE of the command line; ID is the id or name of the object that carries the joint, with [COMPONENT]
/// behind it where it carries several.
/// </summary>
internal static class CoordinateChoice
{
    /// <summary>Index of the coordinate; on -1 the fault says what is wrong.</summary>
    internal static int Find(Mechanism mechanism, string text, out string fault)
    {
        fault = "";
        List<int> found = Named(mechanism, text);
        int dot = text.LastIndexOf('.');
        if (found.Count == 0 && dot > 0 && Enum.TryParse(text[(dot + 1)..], ignoreCase: true, out Coordinate coordinate))
            found = Named(mechanism, text[..dot]).Where(i => mechanism.Coordinates[i].Coordinate == coordinate).ToList();
        if (found.Count == 1)
            return found[0];
        fault = found.Count == 0
            ? $"no joint moves by this name; there are {string.Join(", ", Enumerable.Range(0, mechanism.Coordinates.Count).Select(i => Name(mechanism, i)))}."
            : $"say which: {string.Join(", ", found.Select(i => Name(mechanism, i)))}.";
        return -1;
    }

    private static string Name(Mechanism mechanism, int coordinate) =>
        $"{WithComponent(Object(mechanism, coordinate).Id, mechanism.Coordinates[coordinate])}.{mechanism.Coordinates[coordinate].Coordinate.ToJson()}";

    private static List<int> Named(Mechanism mechanism, string name)
    {
        List<int> all = Enumerable.Range(0, mechanism.Coordinates.Count).Where(i => !mechanism.Coordinates[i].IsLocked).ToList();
        List<int> byId = all.Where(i => Goes(Object(mechanism, i).Id, i)).ToList();
        return byId.Count > 0 ? byId : all.Where(i => Goes(Object(mechanism, i).Name, i)).ToList();

        bool Goes(string by, int i) => by == name || WithComponent(by, mechanism.Coordinates[i]) == name;
    }

    private static string WithComponent(string name, MechanismCoordinate coordinate) => $"{name}[{coordinate.Component}]";

    private static GameObject Object(Mechanism mechanism, int coordinate) =>
        mechanism.Scene.Document.GameObjects[mechanism.Coordinates[coordinate].GameObject];
}
