using System;
using System.Collections.Generic;
using System.Globalization;
using System.IO;
using System.Linq;
using System.Reflection;
using System.Xml;
using NUnit.Framework.Api;
using NUnit.Framework.Interfaces;
using NUnit.Framework.Internal;
using NUnit.Framework.Internal.Builders;

namespace HaptoFlow.Tests.OwnProgram
{
    /// <summary>Runs the tests of its own assembly, for runtimes on which `dotnet test` cannot: Mono, and programs
    /// compiled ahead of time. Arguments: the JUnit file to write, then parts of the full names of tests, "-" before those
    /// to leave out and "+" before those to run alone.</summary>
    internal static class TestProgram
    {
        private static int Main(string[] words)
        {
            var runner = new NUnitTestAssemblyRunner(new Builder());
            var settings = new Dictionary<string, object> { ["NumberOfTestWorkers"] = 0 };
            runner.Load(typeof(TestProgram).Assembly, settings);
            var filter = new NameFilter(words.Skip(1).ToArray());
            ITestResult[] results = Leaves(runner.Run(new Listener(Console.Out), filter)).ToArray();
            WriteJunit(words[0], results);
            int failed = results.Count(result => Outcome(result) == "failure");
            int skipped = results.Count(result => Outcome(result) == "skipped");
            Console.WriteLine($"{results.Length - failed - skipped} passed, {failed} failed, {skipped} skipped");
            return failed > 0 ? 1 : 0;
        }

        /// <summary>The results of single tests, and of fixtures that failed outside of their tests.</summary>
        private static IEnumerable<ITestResult> Leaves(ITestResult result) =>
            result.HasChildren ? result.Children.SelectMany(Leaves)
                : result.Test.IsSuite && Outcome(result) != "failure" ? Enumerable.Empty<ITestResult>()
                : new[] { result };

        private static string Outcome(ITestResult result) => result.ResultState.Status switch
        {
            TestStatus.Passed => "",
            TestStatus.Warning => "",
            TestStatus.Failed => "failure",
            _ => "skipped",
        };

        private static void WriteJunit(string path, ITestResult[] results)
        {
            using XmlWriter xml = XmlWriter.Create(path, new XmlWriterSettings { Indent = true });
            xml.WriteStartElement("testsuite");
            xml.WriteAttributeString("name", typeof(TestProgram).Assembly.GetName().Name);
            Number("tests", results.Length);
            Number("failures", results.Count(result => Outcome(result) == "failure"));
            Number("skipped", results.Count(result => Outcome(result) == "skipped"));
            foreach (ITestResult result in results)
            {
                xml.WriteStartElement("testcase");
                xml.WriteAttributeString("name", Printable(result.FullName));
                xml.WriteAttributeString("time", result.Duration.ToString("F3", CultureInfo.InvariantCulture));
                if (Outcome(result).Length > 0)
                {
                    xml.WriteStartElement(Outcome(result));
                    xml.WriteAttributeString("message", Printable(result.Message ?? ""));
                    xml.WriteString(Printable(result.StackTrace ?? ""));
                    xml.WriteEndElement();
                }
                xml.WriteEndElement();
            }
            xml.WriteEndElement();

            void Number(string name, int value) =>
                xml.WriteAttributeString(name, value.ToString(CultureInfo.InvariantCulture));
        }

        /// <summary>The text without characters that XML does not allow.</summary>
        private static string Printable(string text) =>
            new string(text.Select(letter => XmlConvert.IsXmlChar(letter) ? letter : '?').ToArray());

        /// <summary>Finds the fixtures. NUnit's own builder asks for the assembly's file, and a program compiled
        /// ahead of time has none.</summary>
        private sealed class Builder : ITestAssemblyBuilder
        {
            public ITest Build(Assembly assembly, IDictionary<string, object> options)
            {
                var all = new TestAssembly(assembly, assembly.GetName().Name!);
                var fixtures = new DefaultSuiteBuilder();
                foreach (Type type in assembly.GetTypes())
                {
                    var wrapped = new TypeWrapper(type);
                    if (fixtures.CanBuildFrom(wrapped))
                    {
                        all.Add(fixtures.BuildFrom(wrapped));
                    }
                }
                all.ApplyAttributesToTest(assembly);
                return all;
            }

            public ITest Build(string assemblyName, IDictionary<string, object> options) =>
                throw new NotSupportedException();
        }

        /// <summary>Prints failures as they happen, so that a program that ends early says where.</summary>
        private sealed class Listener : ITestListener
        {
            // NUnit takes the console's own output while tests run.
            private readonly TextWriter console;

            public Listener(TextWriter console) => this.console = console;

            public void TestStarted(ITest test)
            {
            }

            public void TestFinished(ITestResult result)
            {
                if (!result.HasChildren && Outcome(result) == "failure")
                {
                    console.WriteLine($"FAILED {result.FullName}\n{result.Message}\n{result.StackTrace}");
                }
            }

            public void TestOutput(TestOutput output)
            {
            }

            public void SendMessage(TestMessage message)
            {
            }
        }

        private sealed class NameFilter : TestFilter
        {
            private readonly string[] except;
            private readonly string[] only;

            public NameFilter(string[] words)
            {
                except = Marked(words, '-');
                only = Marked(words, '+');
            }

            public override bool Match(ITest test) =>
                test.IsSuite || (!Names(except, test) && (only.Length == 0 || Names(only, test)));

            private static string[] Marked(string[] words, char mark) =>
                words.Where(word => word[0] == mark).Select(word => word.Substring(1)).ToArray();

            private static bool Names(string[] parts, ITest test) =>
                parts.Any(part => test.FullName.Contains(part, StringComparison.Ordinal));

            public override bool Pass(ITest test, bool negated) =>
                test.IsSuite ? test.Tests.Any(child => Pass(child, negated)) : Match(test);

            public override bool IsExplicitMatch(ITest test) => false;

            public override TNode AddToXml(TNode parentNode, bool recursive) => parentNode.AddElement("filter");
        }
    }
}
