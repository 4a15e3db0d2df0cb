using System;
using System.IO;
using System.Threading;
using Kinefab.Diagnostics;
using Kinefab.Json;
using Kinefab.Reading;

namespace Kinefab.Document;

/// <summary>
/// Reads scene files (NAME.kinefab and its buffers), text or binary, told apart by their first bytes.  Faulty data gives a report, never an exception; what the numbers
/// mean together is checked by <c>SceneValidator</c>.
/// </summary>
public static partial class SceneFile
{
    // What takes long is the reading of files and, of large texts, the parsing.
    private const double ShareOfFile = 0.2;
    private const double ShareOfText = 0.6;
    private const double ShareOfBuffers = 0.9;

    /// <summary>Reads a file and the buffers beside it.</summary>
    /// <param name="path">A scene file, NAME.kinefab.</param>
    /// <param name="options">Null: the default ones.</param>
    /// <param name="cancellation">Ends the reading early.</param>
    /// <returns>The document, or null where the report holds an error.</returns>
    /// <exception cref="OperationCanceledException">It was cancelled.</exception>
    public static SceneReading Load(string path, SceneReadOptions? options = null, CancellationToken cancellation = default)
    {
        if (path is null)
            throw new ArgumentNullException(nameof(path));
        options ??= SceneReadOptions.Default;
        var findings = new Findings(options.Limits.MaxFindings);
        byte[]? bytes = null;
        try
        {
            bytes = BoundedFile.Read(path, options.Limits.MaxFileBytes, out long size, cancellation);
            if (bytes is null)
                findings.Add("", DiagnosticCodes.SceneTooLarge, ("size", Invariant.Text(size)), ("limit", Invariant.Text(options.Limits.MaxFileBytes)));
        }
        catch (Exception fault) when (fault is FileNotFoundException or DirectoryNotFoundException)
        {
            findings.Add("", DiagnosticCodes.SceneNotFound, ("path", path));
        }
        catch (Exception fault) when (BoundedFile.IsExpected(fault))
        {
            // Reading a folder fails as reading without the right to does; only the file system tells which it was.
            if (Directory.Exists(path))
                findings.Add("", DiagnosticCodes.SourceIsFolder, ("path", path));
            else
                findings.Add("", DiagnosticCodes.SourceUnreadable, ("path", path), ("detail", fault.Message.TrimEnd('.')));
        }

        if (bytes is null)
            return new SceneReading(null, FindingPlaces.Resolve(findings, default, hasText: false));
        options.Progress?.Report(ShareOfFile);
        cancellation.ThrowIfCancellationRequested();
        SceneReading reading = Parse(bytes, findings, options, cancellation);
        options.Progress?.Report(ShareOfText);
        if (reading.Document is { Buffers.Count: > 0 } document)
            BufferFiles.Attach(document, Path.GetDirectoryName(Path.GetFullPath(path))!, cancellation);
        options.Progress?.Report(ShareOfBuffers);
        return reading;
    }

    /// <summary>Reads a stream from where it stands to its end; it stays open.</summary>
    /// <param name="json">Text, UTF-8, or binary; need not be seekable.</param>
    /// <param name="buffers">Gives the bytes of a buffer by its uri, or null when there are none; null: there are no buffers.</param>
    /// <param name="options">Null: the default ones.</param>
    /// <param name="cancellation">Ends the reading early.</param>
    /// <returns>The document, or null where the report holds an error.</returns>
    /// <exception cref="IOException">The stream cannot be read.</exception>
    /// <exception cref="OperationCanceledException">It was cancelled.</exception>
    public static SceneReading Load(Stream json, Func<string, ReadOnlyMemory<byte>?>? buffers = null, SceneReadOptions? options = null, CancellationToken cancellation = default)
    {
        if (json is null)
            throw new ArgumentNullException(nameof(json));
        options ??= SceneReadOptions.Default;
        byte[]? bytes = BoundedFile.Read(json, options.Limits.MaxFileBytes, out long size, cancellation);
        if (bytes is null)
        {
            var findings = new Findings(options.Limits.MaxFindings);
            findings.Add("", DiagnosticCodes.SceneTooLarge, ("size", Invariant.Text(size)), ("limit", Invariant.Text(options.Limits.MaxFileBytes)));
            return new SceneReading(null, FindingPlaces.Resolve(findings, default, hasText: false));
        }

        options.Progress?.Report(ShareOfFile);
        cancellation.ThrowIfCancellationRequested();
        SceneReading reading = Parse(bytes, buffers, options, cancellation);
        options.Progress?.Report(ShareOfBuffers);
        return reading;
    }

    /// <summary>Reads a stream from where it stands to its end, and the buffers in a folder; the stream stays open.</summary>
    /// <param name="json">Text, UTF-8, or binary; need not be seekable.</param>
    /// <param name="folder">Where the buffers lie.</param>
    /// <param name="options">Null: the default ones.</param>
    /// <param name="cancellation">Ends the reading early.</param>
    /// <returns>The document, or null where the report holds an error.</returns>
    /// <exception cref="IOException">The stream cannot be read.</exception>
    /// <exception cref="OperationCanceledException">It was cancelled.</exception>
    public static SceneReading Load(Stream json, string folder, SceneReadOptions? options = null, CancellationToken cancellation = default)
    {
        if (folder is null)
            throw new ArgumentNullException(nameof(folder));
        SceneReading reading = Load(json, (Func<string, ReadOnlyMemory<byte>?>?)null, options, cancellation);
        if (reading.Document is { Buffers.Count: > 0 } document)
            BufferFiles.Attach(document, folder, cancellation);
        return reading;
    }

    /// <summary>As the other <c>Parse</c>, without the copy: the array is kept and must not be changed any more.</summary>
    /// <param name="json">Text, UTF-8, or binary.</param>
    /// <param name="buffers">Gives the bytes of a buffer by its uri, or null when there are none; null: there are no buffers.</param>
    /// <param name="options">Null: the default ones.</param>
    /// <param name="cancellation">Ends the reading early.</param>
    /// <returns>The document, or null where the report holds an error.</returns>
    /// <exception cref="OperationCanceledException">It was cancelled.</exception>
    public static SceneReading Parse(
        byte[] json,
        Func<string, ReadOnlyMemory<byte>?>? buffers = null,
        SceneReadOptions? options = null,
        CancellationToken cancellation = default)
    {
        if (json is null)
            throw new ArgumentNullException(nameof(json));
        options ??= SceneReadOptions.Default;
        var findings = new Findings(options.Limits.MaxFindings);
        if (json.Length > options.Limits.MaxFileBytes)
        {
            findings.Add("", DiagnosticCodes.SceneTooLarge, ("size", Invariant.Text(json.Length)), ("limit", Invariant.Text(options.Limits.MaxFileBytes)));
            return new SceneReading(null, FindingPlaces.Resolve(findings, default, hasText: false));
        }

        SceneReading reading = Parse(json, findings, options, cancellation);
        if (buffers is not null && reading.Document is not null)
        {
            foreach (SceneBuffer buffer in reading.Document.Buffers)
            {
                if (buffer.Uri is string uri)
                    buffer.Attach(buffers(uri));
            }
        }

        return reading;
    }

    /// <summary>Reads a file in memory; it is copied, so that later findings can give line and column.</summary>
    /// <param name="json">Text, UTF-8, or binary.</param>
    /// <param name="buffers">Gives the bytes of a buffer by its uri, or null when there are none; null: there are no buffers.</param>
    /// <param name="options">Null: the default ones.</param>
    /// <param name="cancellation">Ends the reading early.</param>
    /// <returns>The document, or null where the report holds an error.</returns>
    /// <exception cref="OperationCanceledException">It was cancelled.</exception>
    public static SceneReading Parse(
        ReadOnlySpan<byte> json,
        Func<string, ReadOnlyMemory<byte>?>? buffers = null,
        SceneReadOptions? options = null,
        CancellationToken cancellation = default) => Parse(json.ToArray(), buffers, options, cancellation);

    /// <summary>Reads bytes that the document keeps.</summary>
    private static SceneReading Parse(byte[] bytes, Findings findings, SceneReadOptions options, CancellationToken cancellation)
    {
        BinaryFile file = default;
        bool isBinary = BinaryFile.IsOne(bytes);
        if (isBinary && !BinaryFile.TryOpen(bytes, findings, out file))
            return new SceneReading(null, FindingPlaces.Resolve(findings, default, hasText: false));
        ReadOnlyMemory<byte> text = isBinary ? file.Text : JsonText.WithoutMark(bytes);
        SceneDocument? document = Read(text.Span, findings, options, cancellation);
        Report report = FindingPlaces.Resolve(findings, text.Span, hasText: true);
        if (findings.Errors > 0 || document is null)
            return new SceneReading(null, report);
        if (isBinary)
            document = document with { Container = SceneContainer.Binary };
        document.Text = text;
        OwnBuffer.Attach(document, file.Buffer);
        return new SceneReading(document, report);
    }

    private static SceneDocument? Read(ReadOnlySpan<byte> text, Findings findings, SceneReadOptions options, CancellationToken cancellation)
    {
        if (!JsonText.Check(text, findings))
            return null;
        int maxDepth = Math.Min(options.Limits.MaxDepth, Utf8Tokenizer.MostDepth);
        try
        {
            var progress = new ReadingProgress(options.Progress, ShareOfFile, ShareOfText, cancellation);
            var cursor = new JsonCursor(text, findings, options.Limits.MaxItems, maxDepth, options.Strict, progress);
            var document = new SceneDocument(ref cursor);
            cursor.End();
            return document;
        }
        catch (JsonSyntaxException fault)
        {
            JsonText.ReportBroken(fault, maxDepth, findings);
            return null;
        }
        catch (ReadingEndedException)
        {
            return null;
        }
    }
}
