using System;

namespace Kinefab.Document;

/// <summary>Which uris stay inside the scene's folder on every system.</summary>
internal static class BufferUri
{
    internal static bool IsSafe(string uri)
    {
        if (uri.Length == 0)
            return false;
        foreach (char c in uri)
        {
            // ':' is a drive or a scheme, '\' a separator on Windows alone.
            if (c is ':' or '\\' || char.IsControl(c))
                return false;
        }

        foreach (string part in uri.Split('/'))
        {
            if (part is "" or "." or "..")
                return false;
        }

        return true;
    }
}
