use super::*; use crate::planar::Vector;
#[derive(Clone,Debug,PartialEq)] pub struct BSet { pub intervals: Vec<[f64;2]>, pub period: f64 }
#[derive(Clone,Debug,PartialEq,thiserror::Error)] pub enum NoReach { #[error("no")] Limits }
impl BSet { pub fn overlap(s:&[BSet])->BSet { let a=s.iter().map(|s| s.intervals[0][0]).fold(0.0,f64::max); let b=s.iter().map(|s| s.intervals[0][1]).fold(9.0,f64::min); BSet{intervals: if a<=b {vec![[a,b]]} else {vec![]}, period:s[0].period} } pub fn nearest(&self,b:f64)->Option<f64>{ self.intervals.first().map(|i| b.clamp(i[0],i[1])) } pub fn contains(&self,b:f64)->bool{ self.intervals.iter().any(|i| b>=i[0]&&b<=i[1]) } pub fn inwards(&self,b:f64)->f64{ self.intervals.first().map_or(b,|i| b+(0.5*(i[0]+i[1])-b)*1e-9) } }
impl PlaneMap { pub fn reach(&self,p:Vector)->Result<BSet,NoReach>{ let n=400; let f=|i:usize| i as f64/n as f64*self.period(); let v:Vec<usize>=(0..n).filter(|i| !self.poses(p,f(*i)).is_empty()).collect(); if v.is_empty(){return Err(NoReach::Limits)} Ok(BSet{intervals:vec![[f(v[0]),f(*v.last().unwrap())]],period:self.period()}) }
pub fn self_motion(&self,_p:Vector,_n:usize)->Vec<Vec<PlanePoint>>{ vec![] } }
