using System;
using System.IO;

namespace Kinefab.Document;

/// <summary>Writes files whole or not at all.</summary>
internal static class WholeFile
{
    /// <summary>
    /// Whoever reads, and whenever the writer is killed, there is the old file or the new one.  Behind a link the file it
    /// leads to is written.  The folder has to exist.
    /// </summary>
    internal static void Write(string path, Action<Stream> content)
    {
        string target = Target(Path.GetFullPath(path));

        // In the target's folder, as a rename is atomic within one file system only; a name that no file of the user's has.
        string temporary = Path.Combine(Path.GetDirectoryName(target)!, $".{Path.GetFileName(target)}.{Guid.NewGuid():N}.tmp");
        try
        {
            using (var file = new FileStream(temporary, FileMode.CreateNew, FileAccess.Write))
            {
                content(file);
                file.Flush(flushToDisk: true);
            }

            Move(temporary, target);
        }
        finally
        {
            File.Delete(temporary);
        }
    }

    private static string Target(string path)
    {
#if NET6_0_OR_GREATER
        return new FileInfo(path).LinkTarget is null ? path : File.ResolveLinkTarget(path, returnFinalTarget: true)!.FullName;
#else
        return path;
#endif
    }

    private static void Move(string from, string to)
    {
#if NETCOREAPP3_0_OR_GREATER
        File.Move(from, to, overwrite: true);
#else
        if (File.Exists(to))
            File.Replace(from, to, null);
        else
            File.Move(from, to);
#endif
    }
}
