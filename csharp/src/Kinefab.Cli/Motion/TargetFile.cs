using System;
using System.IO;
using Kinefab.Diagnostics;

namespace Kinefab.Cli.Motion;

/// <summary>Writes a file whole or not at all; a failed attempt leaves nothing behind.</summary>
internal static class TargetFile
{
    /// <summary>What would keep the file from being written: known before the work for it is done.</summary>
    internal static Report Check(string path) => Attempt(path, _ => { }, isKept: false);

    /// <summary>Writes what the content gives; the report has an error when it could not be written.</summary>
    internal static Report Write(string path, Action<Stream> content) => Attempt(path, content, isKept: true);

    /// <summary>The file that is written under a path: behind a link, where it leads, so that the link stays one.</summary>
    /// <exception cref="IOException">Links lead round in a circle.</exception>
    internal static string Behind(string path) =>
        new FileInfo(path).LinkTarget is null ? path : File.ResolveLinkTarget(path, returnFinalTarget: true)!.FullName;

    private static Report Attempt(string path, Action<Stream> content, bool isKept)
    {
        if (Directory.Exists(path))
            return Unwritable(path, "it is a folder");
        string temporary = path;
        try
        {
            string target = Behind(path);
            temporary = Beside(target);
            var file = new FileStream(temporary, FileMode.CreateNew, FileAccess.Write);
            try
            {
                using (file)
                    content(file);
                if (isKept)
                    File.Move(temporary, target, overwrite: true);
            }
            finally
            {
                File.Delete(temporary);
            }

            return Report.Empty;
        }
        catch (DirectoryNotFoundException)
        {
            return Unwritable(path, "its folder does not exist");
        }
        catch (UnauthorizedAccessException)
        {
            return Unwritable(path, "access is denied");
        }
        catch (Exception e) when (e is IOException or NotSupportedException or ArgumentException)
        {
            return Unwritable(path, e.Message.Replace(temporary, path, StringComparison.Ordinal).TrimEnd('.'));
        }
    }

    // In the target's folder, as a rename is atomic within one file system only; a name that no file of the user's has.
    private static string Beside(string target) =>
        Path.Combine(Path.GetDirectoryName(target) ?? "", $".kinefab.{Path.GetRandomFileName()}.part");

    private static Report Unwritable(string path, string detail) =>
        new([Diagnostic.Of("TARGET_UNWRITABLE", "", ("path", path), ("detail", detail))]);
}
