using System;
using System.Formats.Tar;
using System.IO;
using Kinefab.Diagnostics;

namespace Kinefab.Cli.Motion;

/// <summary>Writes a file whole or not at all; a failed attempt leaves nothing behind. A pipe or device is written to as it stands.</summary>
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
            if (TakesNoOther(target))
            {
                if (isKept)
                    Pass(path, content);
                return Report.Empty;
            }

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

    // In the place of a pipe or device no file can be put: a rename would take /dev/null from everybody. What a shell's pipe is behind its link
    // (/dev/stdout, /dev/fd/63) is a name in /proc that is no file, and never is one. .NET tells the kind of a file in a tar's entry alone, and
    // opens no pipe for it.
    private static bool TakesNoOther(string target)
    {
        if (OperatingSystem.IsWindows())
            return false;
        if (!File.Exists(target))
            return target.StartsWith("/proc/", StringComparison.Ordinal);
        if (new FileInfo(target).Length > 0)
            return false;
        using var entry = new MemoryStream();
        try
        {
            using var tar = new TarWriter(entry, TarEntryFormat.Ustar, leaveOpen: true);
            tar.WriteEntry(target, "target");
        }
        catch (UnauthorizedAccessException)
        {
            return false; // a file that may not be read can be replaced
        }

        entry.Position = 0;
        using var read = new TarReader(entry);
        return read.GetNextEntry()!.EntryType != TarEntryType.RegularFile;
    }

    // Made before it is passed on: content that fails half way leaves nothing there either.
    private static void Pass(string path, Action<Stream> content)
    {
        using var whole = new MemoryStream();
        content(whole);
        using var target = new FileStream(path, FileMode.Open, FileAccess.Write);
        whole.WriteTo(target);
    }

    // In the target's folder, as a rename is atomic within one file system only; a name that no file of the user's has.
    private static string Beside(string target) =>
        Path.Combine(Path.GetDirectoryName(target) ?? "", $".kinefab.{Path.GetRandomFileName()}.part");

    private static Report Unwritable(string path, string detail) =>
        new([Diagnostic.Of("TARGET_UNWRITABLE", "", ("path", path), ("detail", detail))]);
}
