using System;
using System.Collections.Generic;
using Kinefab.Json;

namespace Kinefab.Document;

/// <summary>What exporters of format 1.0 tell of a joint in its <c>extras</c>, for want of fields.</summary>
internal static class JointExtras
{
    /// <summary>The user's own name in the source for a joint, or for what stands in a joint's place; null when it is not told.</summary>
    internal static string? Name(Component joint) => joint is Joint { Name: { Length: > 0 } name } ? name : Text(joint, "name");

    /// <summary>Whether the source counts the connected body's motion against the own one.</summary>
    internal static bool CountsConnected(Joint joint) => Text(joint, "counts") == "connected";

    /// <summary>Whether the joint only keeps its bodies from colliding: it holds nothing and stands for no joint of the source.</summary>
    internal static bool KeepsApart(Joint joint) => joint is ConfigurableJoint && Text(joint, "apart") is not null;

    /// <summary>Whether a coordinate's drive is the joint's own spring and damper alone and may come to more than the effort, which bounds no such drive.</summary>
    internal static bool IsOwn(Joint joint, string coordinate)
    {
        foreach ((string _, JsonTree value) in Tree(joint)?["own"]?.Fields ?? Array.Empty<(string, JsonTree)>())
        {
            if (value.ToString() == $"\"{coordinate}\"")
                return true;
        }

        return false;
    }

    /// <summary>Ends of a range that the component itself does not hold, degrees; null where none is told.</summary>
    internal static (double Low, double High)? Range(Joint joint, string field)
    {
        IReadOnlyList<(string Name, JsonTree Value)>? ends = Tree(joint)?[field]?.Fields;
        return ends is { Count: 2 } && Invariant.TryNumber(ends[0].Value.ToString(), out double low) && Invariant.TryNumber(ends[1].Value.ToString(), out double high)
            ? (low, high)
            : null;
    }

    /// <summary>The extras of what stands in a joint's place and has no field for the name; null for none.</summary>
    internal static string? WithName(Joint joint)
    {
        if (joint.Name is not { Length: > 0 } name || Tree(joint) is not JsonTree extras)
            return joint.ExtrasJson;
        JsonTree named = JsonTree.Parse("{}");
        named["name"] = JsonTree.String(name);
        foreach ((string field, JsonTree value) in extras.Fields)
            named[field] = value;
        return named.ToString();
    }

    private static string? Text(Component joint, string field)
    {
        JsonTree? value = Tree(joint)?[field];
        bool isText = value is not null && value.ToString()[0] == '"';
        return isText && value!.AsString() is { Length: > 0 } text ? text : null;
    }

    // Without any: an object without fields.
    private static JsonTree? Tree(Component joint)
    {
        try
        {
            return JsonTree.Parse(joint.ExtrasJson ?? "{}");
        }
        catch (JsonSyntaxException)
        {
            // A scene made in code may hold any text there.
            return null;
        }
    }
}
