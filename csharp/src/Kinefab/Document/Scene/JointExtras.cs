using Kinefab.Json;

namespace Kinefab.Document;

/// <summary>What exporters of format 1.0 tell of a joint in its <c>extras</c>, for want of fields.</summary>
internal static class JointExtras
{
    /// <summary>The user's own name for the joint in the source; null when it is not told.</summary>
    internal static string? Name(Joint joint) => joint.Name is { Length: > 0 } name ? name : Text(joint, "name");

    /// <summary>Whether the source counts the connected body's motion against the own one.</summary>
    internal static bool CountsConnected(Joint joint) => Text(joint, "counts") == "connected";

    /// <summary>Whether the joint only keeps its bodies from colliding: it holds nothing and stands for no joint of the source.</summary>
    internal static bool KeepsApart(Joint joint) => joint is ConfigurableJoint && Text(joint, "apart") is not null;

    private static string? Text(Joint joint, string field)
    {
        if (joint.ExtrasJson is not string json)
            return null;
        try
        {
            JsonTree? value = JsonTree.Parse(json)[field];
            bool isText = value is not null && value.ToString()[0] == '"';
            return isText && value!.AsString() is { Length: > 0 } text ? text : null;
        }
        catch (JsonSyntaxException)
        {
            // A scene made in code may hold any text there.
            return null;
        }
    }
}
