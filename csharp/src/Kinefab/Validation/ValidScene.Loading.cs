using System;
using System.IO;
using System.Threading;
using Kinefab.Diagnostics;
using Kinefab.Document;

namespace Kinefab.Validation;

/// <content>Reading and validating in one: apart, since the validator makes the scene.</content>
public sealed partial class ValidScene
{
    /// <summary>Reads and validates a file and the buffers beside it.</summary>
    /// <param name="path">A scene file, NAME.kinefab.</param>
    /// <param name="options">Null: unknown fields are warnings, limits the default ones.</param>
    /// <param name="cancellation">Ends the reading early.</param>
    /// <returns>The scene; its <see cref="Report"/> holds the warnings.</returns>
    /// <exception cref="SceneFormatException">The file has errors; the exception holds the report.</exception>
    /// <exception cref="OperationCanceledException">It was cancelled.</exception>
    /// <example><code>
    /// ValidScene scene = ValidScene.Load("lever.kinefab");
    /// foreach (Diagnostic warning in scene.Report.Diagnostics)
    ///     Console.WriteLine(warning);
    /// </code></example>
    public static ValidScene Load(string path, SceneReadOptions? options = null, CancellationToken cancellation = default) =>
        Of(SceneFile.Load(path, options, cancellation), options, cancellation);

    /// <summary>Reads and validates what a stream holds from where it stands to its end; the stream stays open.</summary>
    /// <param name="json">A scene as text, UTF-8, or binary; need not be seekable.</param>
    /// <param name="buffers">Gives the bytes of a buffer by its uri, or null when there are none; null: there are no buffers.</param>
    /// <param name="options">Null: unknown fields are warnings, limits the default ones.</param>
    /// <param name="cancellation">Ends the reading early.</param>
    /// <returns>The scene; its <see cref="Report"/> holds the warnings.</returns>
    /// <exception cref="SceneFormatException">The text has errors; the exception holds the report.</exception>
    /// <exception cref="OperationCanceledException">It was cancelled.</exception>
    public static ValidScene Load(Stream json, Func<string, ReadOnlyMemory<byte>?>? buffers = null, SceneReadOptions? options = null, CancellationToken cancellation = default) =>
        Of(SceneFile.Load(json, buffers, options, cancellation), options, cancellation);

    /// <summary>Reads and validates a file in memory, which is copied.</summary>
    /// <param name="json">A scene as text, UTF-8, or binary.</param>
    /// <param name="buffers">Gives the bytes of a buffer by its uri, or null when there are none; null: there are no buffers.</param>
    /// <param name="options">Null: unknown fields are warnings, limits the default ones.</param>
    /// <param name="cancellation">Ends the reading early.</param>
    /// <returns>The scene; its <see cref="Report"/> holds the warnings.</returns>
    /// <exception cref="SceneFormatException">The text has errors; the exception holds the report.</exception>
    /// <exception cref="OperationCanceledException">It was cancelled.</exception>
    /// <example><code>
    /// ValidScene scene = ValidScene.Load(json, uri => parts.TryGetValue(uri, out byte[]? part) ? part : null);
    /// </code></example>
    public static ValidScene Load(ReadOnlyMemory<byte> json, Func<string, ReadOnlyMemory<byte>?>? buffers = null, SceneReadOptions? options = null, CancellationToken cancellation = default)
    {
        cancellation.ThrowIfCancellationRequested();
        return Of(SceneFile.Parse(json.Span, buffers, options, cancellation), options, cancellation);
    }

    private static ValidScene Of(SceneReading reading, SceneReadOptions? options, CancellationToken cancellation)
    {
        if (reading.Document is null)
            throw new SceneFormatException(reading.Report);
        SceneValidation validation = SceneValidator.Validate(reading.Document, options?.Limits, cancellation);
        Report report = reading.Report.Concat(validation.Report);
        if (validation.Scene is null)
            throw new SceneFormatException(report);
        validation.Scene.Report = report;
        options?.Progress?.Report(1);
        return validation.Scene;
    }
}
