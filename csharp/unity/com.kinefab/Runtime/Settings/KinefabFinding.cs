using System;
using System.Collections.Generic;
using Kinefab.Diagnostics;
using Kinefab.Document;

namespace KinefabUnity
{
    /// <summary>How grave a finding is.</summary>
    public enum KinefabSeverity
    {
        /// <summary>To know.</summary>
        Info = 0,

        /// <summary>Something is not as in the source.</summary>
        Warning = 1,

        /// <summary>The file cannot be used.</summary>
        Error = 2,
    }

    /// <summary>Something that was found about a file, or that it lost on its way out of its source.</summary>
    [Serializable]
    public struct KinefabFinding
    {
        /// <summary>How grave it is.</summary>
        public KinefabSeverity severity;

        /// <summary>A code of the table that all of Kinefab shares.</summary>
        public string code;

        /// <summary>What is wrong.</summary>
        public string message;

        /// <summary>What to do about it.</summary>
        public string remedy;

        /// <summary>JSON pointer of the place in the file, or the feature of the source.</summary>
        public string place;

        /// <summary>Line in the file, from 1; 0 where there is none.</summary>
        public int line;

        /// <summary>One line, as the tool prints it.</summary>
        public override string ToString()
        {
            string at = line > 0 ? $"line {line}, " : "";
            return $"{code}{(string.IsNullOrEmpty(place) && at.Length == 0 ? "" : $" ({at}{place})".Replace(", )", ")"))}: {message} {remedy}".TrimEnd();
        }

        internal static KinefabFinding Of(Diagnostic found) => new KinefabFinding
        {
            severity = Grave(found.Severity),
            code = found.Code,
            message = found.Message,
            remedy = found.Remedy,
            place = found.Pointer,
            line = found.Line ?? 0,
        };

        internal static KinefabFinding Of(string code, string place, params (string Name, string Value)[] values) => Of(Diagnostic.Of(code, place, values));

        internal static void Add(Report report, List<KinefabFinding> to)
        {
            foreach (Diagnostic found in report.Diagnostics)
            {
                to.Add(Of(found));
            }
        }

        /// <summary>What the exporter could not carry over as it was.</summary>
        internal static void AddLosses(SceneDocument document, List<KinefabFinding> to)
        {
            foreach (ReportEntry entry in document.Report)
            {
                if (entry.Outcome != Outcome.Kept || entry.Severity == Severity.Error || entry.Severity == Severity.Warning)
                {
                    to.Add(new KinefabFinding
                    {
                        severity = entry.Severity is Severity stated ? Grave(stated) : KinefabSeverity.Info,
                        code = entry.Code ?? "",
                        message = entry.Message ?? $"{entry.Feature} is {(entry.Outcome == Outcome.Dropped ? "dropped" : "approximated")}.",
                        remedy = Remedy(entry.Code),
                        place = entry.Feature,
                    });
                }
            }
        }

        // A file with a loss that was grave for the exporter is whole all the same.
        private static KinefabSeverity Grave(Severity severity) =>
            severity == Severity.Error ? KinefabSeverity.Error : severity == Severity.Warning ? KinefabSeverity.Warning : KinefabSeverity.Info;

        // The report of a file has no remedies; those of the table that leave nothing open hold for every case.
        private static string Remedy(string code)
        {
            try
            {
                string remedy = code == null ? "" : Diagnostic.Of(code, "").Remedy;
                return remedy.IndexOf('{') < 0 ? remedy : "";
            }
            catch (ArgumentException)
            {
                return ""; // of a newer exporter
            }
        }
    }
}
